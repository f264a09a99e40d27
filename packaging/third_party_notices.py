#!/usr/bin/env python3
"""Writes THIRD-PARTY-NOTICES.md: every crate of Cargo.lock, and every package in the studio's page, with its licence
and the texts of its licence files.

Run it after a change of Cargo.lock or studio/package.json:
    npm ci --prefix studio && python3 packaging/third_party_notices.py
`cargo test --test import_layers` checks that no crate is missing.
"""
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
NAMES = ("license", "licence", "copying", "notice", "copyright", "unlicense")


def normalised(text):
    return " ".join(text.split())


def main():
    metadata = json.loads(
        subprocess.run(
            ["cargo", "metadata", "--format-version", "1", "--locked"],
            cwd=ROOT, check=True, capture_output=True, text=True,
        ).stdout
    )
    packages = sorted(
        (package for package in metadata["packages"] if package["source"]),
        key=lambda package: (package["name"], package["version"]),
    )
    page = json.loads((ROOT / "studio/package.json").read_text())["dependencies"]
    for name in sorted(page):
        manifest = ROOT / "studio/node_modules" / name / "package.json"
        packages.append(json.loads(manifest.read_text()) | {"manifest_path": str(manifest)})
    texts = {}
    rows = []
    for package in packages:
        folder = pathlib.Path(package["manifest_path"]).parent
        numbers = []
        for path in sorted(folder.iterdir()):
            if not path.is_file() or not path.name.lower().startswith(NAMES):
                continue
            text = path.read_text(errors="replace").strip()
            known = texts.setdefault(normalised(text), (len(texts) + 1, text))
            numbers.append(known[0])
        shown = ", ".join(f"[{number}](#text-{number})" for number in sorted(set(numbers)))
        name = f"{package['name']} {package['version']}"
        rows.append(f"| {name} | {package['license'] or 'see text'} | {shown or 'the licence named'} |")
    lines = [
        "# Third-party notices",
        "",
        "bankshot is built with these crates, and the studio's page with the packages at the end of the table. Crates that",
        "only tests and builds use are listed too.",
        "The fonts in `assets/` have their licence beside them.",
        "",
        "| crate or package | licence | texts |",
        "|---|---|---|",
        *rows,
    ]
    for number, text in sorted(texts.values()):
        lines += ["", f"## Text {number}", "", "```text", text.replace("```", "'''"), "```"]
    (ROOT / "THIRD-PARTY-NOTICES.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
