# The docs as a site: it builds without a warning, holds every page, finds words, and its links lead somewhere.
source "$(dirname "$0")/common.sh"
command -v mkdocs >/dev/null || { echo "skipped: no mkdocs"; exit 77; }
cd "$GAITD_SOURCE"
expect 0 mkdocs build --strict -q -d "$scratch/site"
expect 0 python3 - "$scratch/site" <<'PYTHON'
import html.parser, json, pathlib, sys, urllib.parse
site = pathlib.Path(sys.argv[1])
nav = pathlib.Path("mkdocs.yml").read_text()
wrong = [str(page) for page in pathlib.Path("docs").rglob("*.md")
         if not page.is_relative_to("docs/examples") and f": {page.relative_to('docs')}\n" not in nav]
if wrong:
    sys.exit(f"not in mkdocs.yml: {wrong}")


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.ids = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.add(value)
            if (tag, name) in (("a", "href"), ("img", "src")) and value and "://" not in value:
                self.links.append(value)


pages = {path.resolve(): Page(path) for path in site.rglob("*.html")}
for path, page in pages.items():
    if path.name in ("404.html", "search.html"):
        continue
    for link in page.links:
        to, _, anchor = link.partition("#")
        target = (path.parent / urllib.parse.unquote(to)).resolve() if to else path
        if not target.exists():
            wrong.append(f"{path.name}: {link}")
        elif anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].ids:
            wrong.append(f"{path.name}: no heading {link}")
index = json.loads((site / "search/search_index.json").read_text())
if not any("capture point" in entry["text"] for entry in index["docs"]):
    wrong.append("the search does not find 'capture point'")
if wrong:
    sys.exit("\n".join(sorted(set(wrong))))
PYTHON
