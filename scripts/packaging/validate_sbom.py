"""Validates bills of materials by the library of CycloneDX: the strict schema, and that the parts fit together."""

import json
import pathlib
import sys

from cyclonedx.model.bom import Bom
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

for file in sys.argv[1:]:
    text = pathlib.Path(file).read_text()
    error = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if error is not None:
        sys.exit(f"{file}: {error}")
    bom = Bom.from_json(json.loads(text))
    bom.validate()
    named = {component.bom_ref.value for component in bom.components} | {bom.metadata.component.bom_ref.value}
    stray = {ref.ref.value for ref in bom.dependencies} ^ named
    if stray:
        sys.exit(f"{file}: expected dependencies of each component, found a difference: {sorted(stray)}")
    unlicensed = [component.name for component in bom.components if not component.licenses]
    if unlicensed:
        sys.exit(f"{file}: expected a licence of each component, found none for {unlicensed}")
    print(f"SBOM: CycloneDX 1.6, {len(bom.components)} components with their dependencies: valid")
