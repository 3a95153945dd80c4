#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds what the documents say and the project no longer has: headings that links point to, files, parameters,
options of the tools, keys of the window. Prints each with its document; exit code 1 if there are any."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOT_OURS = ("build", "output", ".git")
FOREIGN_OPTIONS = {"remove-label", "benchmark_filter", "preset", "build", "install", "prefix", "cflags", "libs"}
FOLDERS = "apps|cmake|datasets|docs|examples|mrpt_module|packaging|scripts|tests"


def files(pattern):
    for path in sorted(ROOT.rglob(pattern)):
        if path.is_file() and path.relative_to(ROOT).parts[0] not in NOT_OURS:
            yield path


def anchor(heading):
    """What GitHub makes of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors_of(text):
    return {anchor(line.lstrip("#")) for line in text.splitlines() if line.startswith("#")}


def parameters():
    """All `section.key` of config.ini, and its sections."""
    keys, section = set(), ""
    for line in (ROOT / "config.ini").read_text().splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        elif match := re.match(r"(\w+) *=", line):
            keys.add(section + "." + match.group(1))
    return keys, {key.split(".")[0] for key in keys}


def sources():
    found = [ROOT / "package.xml"]
    for pattern in ("*.cpp", "*.h", "*.sh", "*.py", "CMakeLists.txt"):
        found += files(pattern)
    return "\n".join(path.read_text(errors="replace") for path in found)


def wrong_in(document, texts, keys, sections, code):
    """What is wrong with a document, a line each."""
    text = texts[document]
    for target, heading in re.findall(r"\]\(([^)#: ]*)#([^)]+)\)", text):
        other = (document.parent / target).resolve() if target else document
        if other in texts and heading not in anchors_of(texts[other]):
            yield f"no such heading: {target}#{heading}"
    for name in re.findall(rf"`((?:{FOLDERS})/[\w./-]+)`", text):
        if not (ROOT / name).exists() and not (document.parent / name).exists():
            yield f"no such file: {name}"
    for section, key in re.findall(rf"`\[?({'|'.join(sections)})[.\]] ?(\w+)", text):
        known = f"{section}.{key}" in keys or key in ("center", "txt", "matching", "h", "cpp")  # no parameters
        if not known:
            yield f"config.ini has no {section}.{key}"
    for option in set(re.findall(r"(?<![\w-])--([a-z][\w-]+)", text)) - FOREIGN_OPTIONS:
        if f"--{option}" not in code:
            yield f"no tool has --{option}"


def missing_keys(window):
    """Keys of the window that its document does not list."""
    code = (ROOT / "apps/obstacle-replay/gui/controls.cpp").read_text()
    for keys, what in re.findall(r"\{[^{},]*(?:',)?[^{},]*, \"([^\"]+)\", \"([^\"]+)\",", code):
        if f"| `{keys}` | {what} |" not in window:
            yield f"lacks the key `{keys}`: {what}"


def main():
    texts = {path: path.read_text() for path in files("*.md") if path.name != "CHANGELOG.md"}
    keys, sections = parameters()
    code = sources()
    wrong = [(document, what) for document in texts for what in wrong_in(document, texts, keys, sections, code)]
    window = ROOT / "docs/window.md"
    wrong += [(window, what) for what in missing_keys(texts[window])]
    for document, what in wrong:
        print(f"{document.relative_to(ROOT)}: {what}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
