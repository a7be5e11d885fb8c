#!/usr/bin/env python3
"""THIRD-PARTY-NOTICES.txt: the licence texts of every crate that is part of the program or of the Python package, for whose sources
there is a copy.

Without arguments it writes both, with --check it fails where one is not of these dependencies. Where a crate offers a
choice, the text is that of MIT. Crates of the same text stand together."""

import json
import os
import subprocess
import sys

FILES = ["THIRD-PARTY-NOTICES.txt", "python/licenses/THIRD-PARTY-NOTICES.txt"]
HEAD = """The program contact-dma and its Python package contain these libraries by others, under these terms.
Written by .ci/notices.py from the versions in Cargo.lock.
"""


def dependencies():
    """Packages that the two products are linked with, on any platform; not what only builds or tests them."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    packages = {package["id"]: package for package in found["packages"]}
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    own, open_ = set(found["workspace_members"]), list(found["workspace_members"])
    reached = set(open_)
    while open_:
        for dependency in nodes[open_.pop()]["deps"]:
            linked = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            # A procedural macro runs in the compiler.
            macro = any("proc-macro" in t["kind"] for t in packages[dependency["pkg"]]["targets"])
            if linked and not macro and dependency["pkg"] not in reached:
                reached.add(dependency["pkg"])
                open_.append(dependency["pkg"])
    return sorted((packages[i] for i in reached - own), key=lambda p: (p["name"], p["version"]))


def text_of(package):
    """The licence files of a crate: of MIT alone where that is offered, else all."""
    folder = os.path.dirname(package["manifest_path"])
    names = [n for n in sorted(os.listdir(folder)) if n.upper().startswith(("LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"))]
    names = [n for n in names if os.path.isfile(os.path.join(folder, n))]
    licence = package["license"] or ""
    if "MIT" in licence.replace("/", " OR ").split(" OR "):
        names = [n for n in names if "MIT" in n.upper()] or names
    texts = []
    for name in names:
        with open(os.path.join(folder, name), errors="replace") as file:
            texts.append("\n".join(line.rstrip() for line in file.read().strip().splitlines()))
    return "\n\n".join(texts) or f"(The package names its licence and has no text of it: {licence}.)"


def notices():
    by_text = {}
    for package in dependencies():
        by_text.setdefault(text_of(package), []).append(package)
    parts = [HEAD]
    for text, packages in sorted(by_text.items(), key=lambda item: item[1][0]["name"]):
        names = "\n".join(f"{p['name']} {p['version']} ({p['license']})" for p in packages)
        parts.append(f"{'=' * 79}\n{names}\n{'-' * 79}\n{text}\n")
    return "\n".join(parts)


def main():
    made = notices()
    for name in FILES:
        if sys.argv[1:] != ["--check"]:
            with open(name, "w") as file:
                file.write(made)
            continue
        with open(name) as file:
            if file.read() != made:
                sys.exit(f"{name} is not of the present dependencies: run .ci/notices.py")


if __name__ == "__main__":
    main()
