"""Every installed header can be used: it compiles on its own, and what it declares is defined in an
installed library.
    installed_headers.py PREFIX
"""
import pathlib
import re
import subprocess
import sys
import tempfile

prefix = pathlib.Path(sys.argv[1])
libraries = sorted((prefix / "lib").glob("libgaitd_*.a"))
symbols = subprocess.run(["nm", "-C", "--defined-only", *map(str, libraries)], check=True,
                         capture_output=True, text=True).stdout
defined = {line.split(" ", 2)[2] for line in symbols.splitlines() if re.match(r"^[0-9a-f]+ [TWVR] ", line)}
names = {re.split(r"[(\[]", text)[0] for text in defined}

INCLUDE = re.compile(r'^#include [<"]([^">]+)[">]', re.M)


def included(name, seen):
    """Everything that a header includes, and what that includes."""
    file = prefix / "include" / name
    for one in INCLUDE.findall(file.read_text()) if file.is_file() else []:
        if one not in seen:
            seen.add(one)
            included(one, seen)
    return seen


# Reading Eigen takes nearly all of the time: it is read once for the headers that include it anyway.
compiler = ["c++", "-std=c++20", f"-I{prefix}/include", "-I/usr/include/eigen3"]
folder = tempfile.TemporaryDirectory()
precompiled = {}
for name in ("Eigen/Geometry", "Eigen/Core"):
    file = pathlib.Path(folder.name) / name.replace("/", "_")
    file.write_text(f"#include <{name}>\n")
    subprocess.run([*compiler, "-x", "c++-header", file, "-o", f"{file}.gch"], check=True)
    precompiled[name] = ["-include", file]

failures = []
headers = sorted((prefix / "include" / "gaitd").rglob("*.h"))
for header in headers:
    include = header.relative_to(prefix / "include")
    source = f'#include "{include}"\n#include "{include}"\nint main() {{}}\n'
    seen = included(str(include), set())
    eigen = next((flags for name, flags in precompiled.items() if name in seen), [])
    compiled = subprocess.run(
        [*compiler, *eigen, "-fsyntax-only", "-x", "c++", "-"], input=source, capture_output=True, text=True)
    if compiled.returncode != 0:
        failures.append(f"{include}: does not compile on its own: {compiled.stderr.splitlines()[0]}")
        continue
    text = re.sub(r"//[^\n]*", "", header.read_text())
    space = re.search(r"^namespace ([\w:]+) \{", text, re.M)
    if space is None:
        continue
    # Free functions without a body: declared at the beginning of a line, ended by a semicolon.
    for match in re.finditer(r"^(?!inline|constexpr|template|using|struct|class|enum|return|namespace|"
                             r"extern|static|typedef)[A-Za-z][\w:<>,&* ]*?[ &*](\w+)\([^;{}=]*\)( noexcept)?;",
                             text, re.M):
        name = f"{space[1]}::{match[1]}"
        if not any(known == name for known in names):
            failures.append(f"{include}: no installed library defines {name}")
    # Classes that are built somewhere: one of their constructors is declared without a body.
    for match in re.finditer(r"^(?:class|struct) (\w+)\b[^;{]*\{(.*?)^\};", text, re.M | re.S):
        constructor = re.search(rf"^  (?:explicit )?{match[1]}\([^{{}}=:]*\);", match[2], re.M)
        name = f"{space[1]}::{match[1]}::{match[1]}"
        if constructor and name not in names:
            failures.append(f"{include}: no installed library defines {name}")
for failure in failures:
    print(failure, file=sys.stderr)
print(f"{len(headers)} headers, {len(libraries)} libraries, {len(failures)} failures")
sys.exit(1 if failures or not headers else 0)
