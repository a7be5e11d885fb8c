#!/usr/bin/env python3
"""The sources of the documentation site: the guides as they are, the README as the first page, the commands by their help, and a
gallery of every example in sweeps/, each run by the program.

    make.py PROGRAM FOLDER
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "packaging/site"
REPOSITORY = re.search(r'^repository = "(.*)"$', (ROOT / "Cargo.toml").read_text(), re.M)[1] + "/blob/main"
PAGES = {"README.md": "index.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
GALLERY = """# Gallery

Every example of `sweeps/`, its question, the command that answers it and the first figure of the answer. `sweeps/schema` has the
schemas by which an editor completes and checks such files.
"""


def page(path, to):
    """A page of the repository, whose links lead to pages of the site, or into the repository."""

    def moved(match):
        before, target, after = match.groups()
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        name, _, anchor = target.partition("#")
        file = (path.parent / name).resolve()
        inside = file.relative_to(ROOT).as_posix()
        if inside in PAGES:
            name = PAGES[inside]
        elif inside.startswith("src/guide/"):
            name = file.name
        elif file.suffix in (".png", ".svg"):
            name = f"figures/{file.name}"
            (to / "figures").mkdir(exist_ok=True)
            shutil.copy(file, to / name)
        else:
            name = f"{REPOSITORY}/{inside}"
        return f"{before}{name}{'#' + anchor if anchor else ''}{after}"

    text = path.read_text(encoding="utf-8")
    text = re.sub(r"(\]\()([^)\s]+)(\))", moved, text)
    return re.sub(r"(?m)(^\[[^\]]+\]: )(\S+)(.*)$", moved, text)


def run(*arguments, accepted=(0,)):
    made = subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True)
    if made.returncode not in accepted:
        sys.exit(f"{' '.join(map(str, arguments))} ended with {made.returncode}:\n{made.stderr}")
    return made.stdout


def commands(program):
    """What the help of every command says."""
    text = run(program, "--help")
    codes = text[text.index("Exit codes:") :].splitlines()[1:]
    rows = "".join(f"| {line.split(None, 1)[0]} | {line.split(None, 1)[1]} |\n" for line in codes if line.strip())
    parts = [f"# Commands and exit codes\n\n| exit code | |\n|---|---|\n{rows}"]

    def below(path, text):
        for name in re.findall(r"(?m)^  ([a-z]+)(?: |$)", text.partition("Commands:")[2].partition("\n\n")[0]):
            if name != "help":
                inner = run(program, *path, name, "--help")
                if "Commands:" in inner:
                    below([*path, name], inner)
                else:
                    parts.append(f"## {' '.join([*path, name])}\n\n```text\n{inner.strip()}\n```\n")

    below([], text)
    return "\n".join(parts)


def example(program, file, to):
    """A part of the gallery."""
    text = file.read_text(encoding="utf-8")
    comment = []
    for line in text.splitlines():
        if not line.startswith("#") or line.startswith("#:"):
            break
        comment.append(line.lstrip("# "))
    question, *rest = comment
    command = "identify" if "[identify]" in text else "sweep" if "[sweep]" in text else "simulate"
    folder = to / "made" / file.stem
    # One that ends with 3 has cases without a result, which its figures show.
    run(program, command, file.relative_to(ROOT), "--quiet", "--out", folder, accepted=(0, 3))
    captions = sorted((folder / "figures").glob("*.caption.txt"))
    names = [caption.name.removesuffix(".caption.txt") for caption in captions]
    first = next((name for name in ("energy-loss", "energy-loss-map", "loss-map", "history", "moduli", "fit") if name in names), names[0])
    picture = f"figures/{file.stem}.svg"
    shutil.copy(folder / f"figures/{first}.svg", to / picture)
    caption = (folder / f"figures/{first}.caption.txt").read_text(encoding="utf-8").strip()
    parts = [f"## {question}", " ".join(line for line in rest if line), f"```sh\ncontact-dma {command} sweeps/{file.name}\n```"]
    parts += [f"![{question}]({picture})", f"*{caption}*".replace("\n", " ")]
    parts += [f"<details><summary>{file.name}</summary>\n\n```toml\n{text.strip()}\n```\n\n</details>"]
    return "\n\n".join(part for part in parts if part) + "\n"


def main():
    program, to = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    (to / "figures").mkdir(parents=True)
    for path in [*map(ROOT.joinpath, PAGES), *(ROOT / "src/guide").glob("*.md")]:
        inside = path.relative_to(ROOT).as_posix()
        (to / PAGES.get(inside, path.name)).write_text(page(path, to), encoding="utf-8")
    # The columns have a page of their own too, in the part of the site where one looks things up.
    results = (to / "results.md").read_text(encoding="utf-8")
    _, columns = results.split("## Columns\n")
    (to / "columns.md").write_text(f"# Columns of the tables\n{columns}", encoding="utf-8")
    (to / "commands.md").write_text(commands(program), encoding="utf-8")
    files = sorted((ROOT / "sweeps").glob("*.toml"))
    gallery = [example(program, file, to) for file in files]
    (to / "gallery.md").write_text("\n".join([GALLERY, *gallery]), encoding="utf-8")
    shutil.rmtree(to / "made")
    shutil.copy(HERE / "SUMMARY.md", to)


if __name__ == "__main__":
    main()
