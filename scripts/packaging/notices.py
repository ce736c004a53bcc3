"""Prints the licences of the libraries that the program contains, each text once.

`cargo metadata` on standard input; the first argument is a file with one `NAME vVERSION` per line, further ones are
licence files that are added. A crate that was published without the text of its licence gets the usual text of it, with
the authors that it names."""

import json
import pathlib
import sys

BEGINNINGS = ("LICEN", "COPYING", "NOTICE", "COPYRIGHT", "UNLICENSE")
TOP = pathlib.Path(__file__).parent.parent.parent
RULE = "=" * 78


def usual_text(package: dict) -> str:
    """The licence of a crate that has no text of it, where there is a choice Apache-2.0."""
    licence = package["license"] or ""
    authors = ", ".join(package["authors"]) or f"the authors of {package['repository']}"
    if "Apache-2.0" in licence:
        return (TOP / "LICENSE-APACHE").read_text().strip()
    if "MIT" in licence:
        permission = (TOP / "LICENSE-MIT").read_text().split("Permission is hereby", 1)[1]
        return f"MIT License\n\nCopyright (c) {authors}\n\nPermission is hereby{permission}".strip()
    sys.exit(f"{package['name']}: no text of its licence {licence}; help: add it to scripts/packaging/notices.py")


def texts_of(package: dict) -> list[str]:
    """The texts of a crate's licences."""
    folder = pathlib.Path(package["manifest_path"]).parent
    files = [file for file in sorted(folder.rglob("*")) if file.is_file() and file.name.upper().startswith(BEGINNINGS)]
    # Of code that is compiled by a build script, too; not of programs that have such a name.
    texts = [file.read_text(errors="replace").strip() for file in files if file.suffix.lower() in ("", ".md", ".txt")]
    return texts or [usual_text(package)]


def main() -> None:
    tree, *more = sys.argv[1:]
    inside = {tuple(line.split()[:2]) for line in open(tree) if line.strip()}
    texts: dict[str, list[str]] = {}
    packages = json.load(sys.stdin)["packages"]
    for package in sorted(packages, key=lambda it: (it["name"], it["version"])):
        name, version = package["name"], package["version"]
        if (name, f"v{version}") not in inside or package["source"] is None:
            continue
        for text in texts_of(package):
            texts.setdefault(text, []).append(f"{name} {version}")
    for file in more:
        texts.setdefault(pathlib.Path(file).read_text().strip(), []).append(file.split("/")[-2])
    print("whichone: MIT OR Apache-2.0. It contains these libraries, under their own licences; those for optional")
    print("features only if it was built with them (whichone --version).\n")
    for text, names in texts.items():
        print(f"{RULE}\n{', '.join(dict.fromkeys(names))}\n{RULE}\n{text}\n")


main()
