"""Prints the software bill of materials of the program `whichone` in the format CycloneDX 1.6.

The argument is the version. It lists every crate that the default build links or runs at build time, with its licence,
its checksum and what it depends on, and the libraries of the page. The same sources print the same bytes."""

import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib
import uuid

TOP = pathlib.Path(__file__).parent.parent.parent
VENDOR = TOP / "services/console/page/vendor"


def cargo(*words: str) -> str:
    return subprocess.run(["cargo", *words], cwd=TOP, check=True, capture_output=True, text=True).stdout


def graph(metadata: dict) -> dict[str, list[str]]:
    """What each package of the program depends on: normal and build dependencies, as its features ask for them."""
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = next(it["id"] for it in metadata["packages"] if it["name"] == "whichone" and it["source"] is None)
    found, waiting = {}, [root]
    while waiting:
        package = waiting.pop()
        if package in found:
            continue
        kept = [it["pkg"] for it in nodes[package]["deps"] if any(k["kind"] != "dev" for k in it["dep_kinds"])]
        found[package] = sorted(set(kept))
        waiting += kept
    return found


def licences(package: dict) -> list[dict]:
    expression = (package["license"] or "").replace("/", " OR ")
    return [{"expression": expression}] if expression else []


def crate(package: dict, checksums: dict, version: str) -> dict:
    is_own = package["source"] is None
    component = {
        "type": "library",
        "bom-ref": reference(package),
        "name": package["name"],
        "version": version if is_own else package["version"],
        "scope": "required",
        "licenses": licences(package),
    }
    if not is_own:
        component["purl"] = f"pkg:cargo/{package['name']}@{package['version'].replace('+', '%2B')}"
        checksum = checksums[package["name"], package["version"]]
        component["hashes"] = [{"alg": "SHA-256", "content": checksum}]
    if package.get("repository"):
        component["externalReferences"] = [{"type": "vcs", "url": package["repository"].strip()}]
    return component


def reference(package: dict) -> str:
    return f"{package['name']}@{package['version']}"


def vendored() -> list[dict]:
    """The libraries of the page, from the table of their README."""
    rows = re.findall(r"^\| \[([\w-]+)\]\((\S+)\) \| ([\d.]+) \| ([\w.-]+) ", (VENDOR / "README.md").read_text(), re.M)
    if not rows:
        sys.exit(f"{VENDOR}/README.md: expected rows of libraries, found none")
    return [
        {
            "type": "library",
            "bom-ref": f"npm:{name}@{version}",
            "name": name,
            "version": version,
            "scope": "required",
            "licenses": [{"expression": licence}],
            "purl": f"pkg:npm/{name}@{version}",
            "externalReferences": [{"type": "distribution", "url": url}],
        }
        for name, url, version, licence in rows
    ]


def main() -> None:
    version = sys.argv[1]
    host = re.search(r"^host: (.*)$", subprocess.run(["rustc", "-vV"], capture_output=True, text=True).stdout, re.M)[1]
    metadata = json.loads(cargo("metadata", "--locked", "--format-version", "1", "--filter-platform", host))
    packages = {package["id"]: package for package in metadata["packages"]}
    lock = tomllib.loads((TOP / "Cargo.lock").read_text())["package"]
    checksums = {(it["name"], it["version"]): it.get("checksum") for it in lock}
    found = graph(metadata)
    whole = next(packages[it] for it in found if packages[it]["name"] == "whichone")
    components = [crate(packages[it], checksums, version) for it in found if packages[it] is not whole] + vendored()
    components.sort(key=lambda it: it["bom-ref"])
    page = [it["bom-ref"] for it in components if it["bom-ref"].startswith("npm:")]
    dependencies = [
        {"ref": reference(packages[it]), "dependsOn": sorted(reference(packages[d]) for d in found[it])} for it in found
    ]
    for one in dependencies:
        if one["ref"].startswith("console@"):
            one["dependsOn"] += page
    moment = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), datetime.timezone.utc)
    program = {**crate(whole, checksums, version), "type": "application", "purl": f"pkg:cargo/whichone@{version}"}
    content = {
        "metadata": {"timestamp": moment.isoformat().replace("+00:00", "Z"), "component": program},
        "components": components,
        "dependencies": sorted(dependencies, key=lambda it: it["ref"]) + [{"ref": it, "dependsOn": []} for it in page],
    }
    name = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(content, sort_keys=True))
    head = {"bomFormat": "CycloneDX", "specVersion": "1.6", "serialNumber": f"urn:uuid:{name}", "version": 1}
    print(json.dumps({**head, **content}, indent=1, ensure_ascii=False))


main()
