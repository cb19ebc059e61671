#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the size and offset tables of abi_layout.h anew, after a field was appended to a struct.

Look at the difference before committing it: no offset that is there may change.
"""
import pathlib
import re
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
INCLUDE = HERE.parent / "include"
HEADERS = [INCLUDE / "gaitd/abi" / f"{name}.h"
           for name in ("model", "state", "gait", "motions", "control", "plugin", "backend")]
STRUCT = re.compile(r"typedef struct (\w+) \{(.*?)\n\} \1;", re.S)
FUNCTION = re.compile(r"\(\*(\w+)\)\(")
FIELD = re.compile(r"(\w+)(?:\[[^\]]*\])*$")


def fields(body):
    body = re.sub(r"/\*.*?\*/", "", body, flags=re.S)
    for declaration in body.split(";"):
        function = FUNCTION.search(declaration)
        field = function or FIELD.search(declaration.strip())
        if field:
            yield field.group(1)


def main():
    structs = []
    for header in HEADERS:
        structs += [(m.group(1), list(fields(m.group(2)))) for m in STRUCT.finditer(header.read_text())]
    program = ["#include <stddef.h>", "#include <stdio.h>"]
    program += [f'#include "{header}"' for header in HEADERS]
    program += ["int main(void) {"]
    program += [f'printf("{name} %zu\\n", sizeof({name}));' for name, _ in structs]
    program += [f'printf("{name}, {field}, %zu\\n", offsetof({name}, {field}));'
                for name, names in structs for field in names]
    program += ["return 0;", "}"]
    with tempfile.TemporaryDirectory() as folder:
        source, binary = pathlib.Path(folder, "layout.c"), pathlib.Path(folder, "layout")
        source.write_text("\n".join(program))
        subprocess.run(["cc", "-std=c99", f"-I{INCLUDE}", source, "-o", binary], check=True)
        lines = subprocess.run([binary], check=True, capture_output=True, text=True).stdout.splitlines()
    sizes = [f"  X({line.replace(' ', ', ')})" for line in lines if "," not in line]
    offsets = [f"  X({line})" for line in lines if "," in line]
    tables = ("#define GAITD_ABI_SIZES(X) \\\n" + " \\\n".join(sizes) +
              "\n\n#define GAITD_ABI_OFFSETS(X) \\\n" + " \\\n".join(offsets) + "\n")
    path = HERE / "abi_layout.h"
    path.write_text(re.sub(r"(/\* clang-format off \*/\n).*?(/\* clang-format on \*/)",
                           lambda m: m.group(1) + tables + m.group(2), path.read_text(), flags=re.S))


if __name__ == "__main__":
    main()
