#!/usr/bin/env python3
"""Prints a software bill of materials of the command, or with the word `python` of the package for Python: CycloneDX 1.5 as JSON.

It has no time and no random number in it, so the same tree gives the same bytes.
"""

import json
import re
import sys
import tomllib

from shipped import PRODUCTS, is_own, product, shipped


def checksums(of: str) -> dict[tuple[str, str], str]:
    """The SHA-256 of each crate's archive, by name and version, as Cargo.lock has them."""
    lock = tomllib.loads((PRODUCTS[of][0] / "Cargo.lock").read_text("utf-8"))
    return {(it["name"], it["version"]): it["checksum"] for it in lock["package"] if "checksum" in it}


def reference(package: dict) -> str:
    """What names a crate within the document."""
    return f"{package['name']}@{package['version']}"


def component(package: dict, known: dict[tuple[str, str], str]) -> dict:
    """One crate."""
    name, version = package["name"], package["version"]
    found = {
        "type": "library",
        "bom-ref": reference(package),
        "name": name,
        "version": version,
        "purl": f"pkg:cargo/{name}@{version}",
    }
    if package["license"]:
        # The old way to write "or", which is not an SPDX expression.
        found["licenses"] = [{"expression": re.sub(r"\s*/\s*", " OR ", package["license"])}]
    if checksum := known.get((name, version)):
        found["hashes"] = [{"alg": "SHA-256", "content": checksum}]
    if is_own(package):
        # It is in no registry.
        del found["purl"]
    return found


def main() -> int:
    of = product()
    known, packages = checksums(of), shipped(of)
    whole = next(package for package in packages if package["name"] == PRODUCTS[of][1])
    kind = "application" if of == "command" else "library"
    libraries = [component(package, known) for package in packages if package is not whole]
    document = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": component(whole, known) | {"type": kind}},
        "components": libraries,
        "dependencies": [
            {"ref": reference(it), "dependsOn": [reference(packages[at]) for at in it["links"]]} for it in packages
        ],
    }
    json.dump(document, sys.stdout, indent=1)
    print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
