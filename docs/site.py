# SPDX-License-Identifier: Apache-2.0
"""Hooks of mkdocs.yml. Links to files outside docs/ name them in the site instead: it holds the pages only."""
import re

OUTSIDE = re.compile(r"\[([^\]]*)\]\((?:\.\./)+(?!gauntlet\.md|[a-z-]+\.md)([^)#]+)(?:#[^)]*)?\)")


def on_page_markdown(markdown, page, **_):
    if page.file.src_uri.count("/"):  # docs/decisions: its links lead back into docs/
        return markdown
    return OUTSIDE.sub(r"\1 (`\2`)", markdown)
