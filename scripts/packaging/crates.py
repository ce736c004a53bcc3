"""Packages the crates that `whichone-sdk` is made of as they would be published, and builds them from their packages.

The argument is a folder, which is replaced: a workspace of copies, in which each crate is called `whichone-NAME` and
keeps NAME as the name that code imports. In the registry the plain names are others'. `cargo publish --workspace` in
that folder publishes them."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

TOP = pathlib.Path(__file__).parent.parent.parent
SDK = "whichone-sdk"
ABOUT = {
    "diagnostics": "Errors of configuration files with file, line, key and fix",
    "messages": "Messages of whichone, a robot that asks which one you mean, and their wire layout",
    "perception": "Objects that whichone tracks from reports of cameras",
    "runtime": "Bus, client and lifecycle of a process in a group of whichone",
    "scene": "Objects, attributes and words of a scene of whichone",
    "vocabulary": "Types that whichone's dialogue and its services share",
}


def published(name: str) -> str:
    return name if name.startswith("whichone") else f"whichone-{name.replace('_', '-')}"


def members() -> dict[str, pathlib.Path]:
    """The SDK's crate and everything of this workspace that it is built from."""
    command = ["cargo", "metadata", "--locked", "--no-deps", "--format-version", "1"]
    metadata = json.loads(subprocess.run(command, cwd=TOP, check=True, capture_output=True, text=True).stdout)
    packages = {it["name"]: it for it in metadata["packages"]}
    found, waiting = {}, [SDK]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found[name] = pathlib.Path(packages[name]["manifest_path"]).parent
            waiting += [it["name"] for it in packages[name]["dependencies"] if it.get("path") and it["kind"] is None]
    return found


def stage(name: str, source: pathlib.Path, folder: pathlib.Path) -> None:
    """A copy of a crate without its tests, which use files of the repository."""
    folder.mkdir(parents=True)
    for part in ("src", "build.rs"):
        if (source / part).is_dir():
            shutil.copytree(source / part, folder / part)
        elif (source / part).exists():
            shutil.copy(source / part, folder / part)
    for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
        shutil.copy(TOP / licence, folder / licence)
    text = (source / "Cargo.toml").read_text()
    about = tomllib.loads(text)["package"].get("description") or ABOUT[name]
    text = re.sub(r"^\[(dev-dependencies|\[test\]|\[example\])\]+\n(?:(?!\[).*\n?)*", "", text, flags=re.M)
    head = f'[package]\nname = "{published(name)}"\ndescription = "{about}"\nautotests = false\n'
    head += "repository.workspace = true\n"
    text = re.sub(r'^\[package\]\nname = ".*"\n(description = ".*"\n)?', head, text)
    library = name.replace("-", "_")
    if "[lib]" not in text:
        text = text.replace("[lints]", f'[lib]\nname = "{library}"\n\n[lints]', 1)
    (folder / "Cargo.toml").write_text(text)


def workspace(found: dict[str, pathlib.Path]) -> str:
    """The root manifest: the repository's, with the crates under the names in the registry."""
    root = tomllib.loads((TOP / "Cargo.toml").read_text())
    version = root["workspace"]["package"]["version"]
    names = sorted(found)
    lines = ["[workspace]", 'resolver = "3"', f"members = {json.dumps(names)}", "", "[workspace.package]"]
    fields = {**root["workspace"]["package"], "publish": True}
    # The one place with the forge's address.
    fields["repository"] = re.search(r"^forge=(\S+)", (TOP / "README.md").read_text(), re.M)[1]
    lines += [f"{key} = {json.dumps(value)}" for key, value in fields.items()]
    lines += ["", "[workspace.dependencies]"]
    own = {name: f'{{ package = "{published(name)}", path = "{name}", version = "={version}" }}' for name in names}
    lines += [f"{name} = {text}" for name, text in own.items()]
    manifest = (TOP / "Cargo.toml").read_text()
    table = manifest.split("[workspace.dependencies]", 1)[1].split("\n[", 1)[0]
    lines += [line for line in table.splitlines() if "=" in line and not line.startswith("#") and "path = " not in line]
    lints = manifest.split("[workspace.lints.rust]", 1)[1].split("\n[profile", 1)[0]
    return "\n".join(lines) + "\n\n[workspace.lints.rust]" + lints


def main() -> None:
    out = pathlib.Path(sys.argv[1])
    shutil.rmtree(out, ignore_errors=True)
    found = members()
    for name, source in found.items():
        stage(name, source, out / name)
    (out / "Cargo.toml").write_text(workspace(found))
    shutil.copy(TOP / "Cargo.lock", out / "Cargo.lock")
    # The libraries are of the versions that the repository is tested with; its lock file lists more, and other names.
    subprocess.run(["cargo", "update", "--workspace", "--quiet"], cwd=out, check=True)
    subprocess.run(["cargo", "package", "--workspace", "--allow-dirty", "--quiet"], cwd=out, check=True)
    for package in sorted((out / "target" / "package").glob("*.crate")):
        print(f"{package.stat().st_size:>8}  {package.name}")


main()
