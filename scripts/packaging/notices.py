"""Prints the licence files of the crates that a program contains, each text once.

`cargo metadata` on standard input; the first argument is a file with one `NAME vVERSION` per line, further ones are
licence files that are added."""

import json
import pathlib
import sys

tree, *more = sys.argv[1:]
inside = {tuple(line.split()[:2]) for line in open(tree) if line.strip()}
texts: dict[str, list[str]] = {}
for package in json.load(sys.stdin)["packages"]:
    name, version = package["name"], package["version"]
    if (name, f"v{version}") not in inside or package["source"] is None:
        continue
    folder = pathlib.Path(package["manifest_path"]).parent
    for file in sorted(folder.iterdir()):
        if file.is_file() and file.name.upper().startswith(("LICEN", "COPYING", "NOTICE", "COPYRIGHT", "UNLICENSE")):
            texts.setdefault(file.read_text(errors="replace").strip(), []).append(f"{name} {version}")
for file in more:
    texts.setdefault(pathlib.Path(file).read_text().strip(), []).append(file.split("/")[-2])
for text, names in texts.items():
    print("=" * 78)
    print(", ".join(names))
    print("=" * 78)
    print(text)
    print()
