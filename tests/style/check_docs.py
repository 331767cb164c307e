#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the documents against the tree: links lead somewhere, and what stands in backticks is there: files and
folders, commands and options of fexp, keys of the deck, and files of a run. So is what calls in code blocks name.

usage: check_docs.py PROJECT | --self-test
"""
import re
import sys
import tempfile
from pathlib import Path

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$|^    [^\n]*$", re.MULTILINE | re.DOTALL)
PATH = re.compile(r"(\./)?[\w.-]+(/[\w.-]+)*/?")
FILE = re.compile(r"[\w-]+(\.[\w-]+)*\.(cpp|hpp|py|txt|md|toml|cmake|csv|json|vtkhdf|xdmf2|msh|geo|png)")
COMMAND = re.compile(r"(?:\./)?fexp ([a-z]+)\b")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
KEY = re.compile(r"([a-z_]+)\.([a-z_]+)")
LEFT_OUT = ("build", ".git")


def anchors_of(text):
    """Anchors that GitHub makes of the headings."""
    titles = re.findall(r"^#+ +(.*?) *$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


class Project:
    def __init__(self, root):
        self.root = root
        pages = (page for page in sorted(root.rglob("*.md")) if page.relative_to(root).parts[0] not in LEFT_OUT)
        self.pages = {page: page.read_text(encoding="utf-8") for page in pages}
        sources = [path for path in sorted((root / "src").rglob("*.[ch]pp")) if path.is_file()]
        self.source = "\n".join(path.read_text(encoding="utf-8") for path in sources)
        self.scripts = "\n".join((root / name).read_text(encoding="utf-8") for name in ("fexp", "test"))
        self.keys = self.deck_keys()

    def deck_keys(self):
        """Section -> its keys, from the generated reference."""
        keys = {}
        section = None
        for line in self.pages.get(self.root / "docs/deck.md", "").splitlines():
            if line.startswith("## "):
                found = re.fullmatch(r"## `\[+(\w+)\]+`", line)
                section = keys.setdefault(found[1], set()) if found else None
            elif section is not None and (found := re.match(r"\| `(\w+)` \|", line)):
                section.add(found[1])
        return keys

    def is_there(self, page, name):
        """A path, seen from the root or from the page; or the name of a file that the program writes."""
        path = name.removeprefix("./")
        if (self.root / path).exists() or (page.parent / path).exists():
            return True
        if "/" in name:
            return False
        stem = name.rsplit(".", 1)[0]
        return f'"{name}"' in self.source or (name.endswith(".csv") and f'("{stem}")' in self.source)

    def faults_of_link(self, page, target):
        if re.match(r"[a-z]+:", target):
            return
        name, _, anchor = target.partition("#")
        path = page.parent / name if name else page
        if not path.exists():
            yield f"the link to {target} leads nowhere"
        elif anchor and anchor not in anchors_of(path.read_text(encoding="utf-8")):
            yield f"{name or 'the page'} has no heading for #{anchor}"

    def faults_of_code(self, page, code):
        word = code.split()[0] if code.split() else ""
        key = KEY.fullmatch(code)
        if key and key[1] in self.keys:
            if key[2] not in self.keys[key[1]]:
                yield f"the deck has no key {code}"
        elif FILE.fullmatch(code) or code.startswith("./") or (
                "/" in code and PATH.fullmatch(code) and (self.root / code.split("/")[0]).is_dir()):
            if not self.is_there(page, word):
                yield f"{word} is not there"
        for command in COMMAND.findall(code):
            if f'_command{{"{command}"' not in self.source:
                yield f"fexp has no command {command}"
        if word.removeprefix("./") in ("fexp", "test") or code.startswith("--"):
            for option in OPTION.findall(code):
                if not re.search(rf"(?<![\w-]){option}(?![\w-])", self.source + self.scripts):
                    yield f"there is no option {option}"

    def faults_of_call(self, page, line):
        """A line of a code block that calls fexp or the tests: what it names by path is there, too."""
        words = line.split()
        if words and words[0] in ("fexp", "./fexp", "./test"):
            yield from self.faults_of_code(page, " ".join(words))
            for word in words[1:]:
                if (self.root / word.split("/")[0]).is_dir() and "/" in word and not self.is_there(page, word):
                    yield f"{word} is not there"

    def faults(self):
        for page, text in self.pages.items():
            # Generated, and held against the program by tests of their own.
            if page in (self.root / "docs/deck.md", self.root / "docs/errors.md"):
                continue
            prose = FENCE.sub(lambda m: "\n" * m[0].count("\n"), text).splitlines()
            for number, (line, whole) in enumerate(zip(prose, text.splitlines()), 1):
                found = [fault for target in LINK.findall(line) for fault in self.faults_of_link(page, target)]
                found += self.faults_of_call(page, whole) if line != whole else []
                found += [fault for code in CODE.findall(line) for fault in self.faults_of_code(page, code)]
                for fault in found:
                    yield f"{page.relative_to(self.root)}:{number}: {fault}"


SOUND = """# Title
[here](docs/deck.md) [there](#title) `src/a.cpp` `docs/` `fexp run DECK` `--out` `run.safety` `log.txt` `nodes.csv`

    `src/code_is_left_out.cpp`
    ./fexp run docs/deck.md --out nowhere/yet
"""
PLANTED = {
    "[a](docs/none.md)": "leads nowhere",
    "![a](none.png)": "leads nowhere",
    "[a](docs/deck.md#none)": "no heading",
    "`src/none.cpp`": "is not there",
    "`./none`": "is not there",
    "`none.csv`": "is not there",
    "`fexp walk DECK`": "no command",
    "`fexp run --none`": "no option",
    "`--none`": "no option",
    "`run.none`": "no key",
    "    ./fexp run docs/none.toml": "is not there",
    "    fexp run DECK --none": "no option",
}


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in {
            "docs/deck.md": "## `[run]`\n\n| `safety` | a number |\n",
            "src/a.cpp": 'Command run_command{"run", "--out"}; "log.txt" history("nodes")',
            "fexp": "",
            "test": "",
        }.items():
            (root / name).parent.mkdir(exist_ok=True)
            (root / name).write_text(text)
        for planted, expected in PLANTED.items():
            (root / "README.md").write_text(SOUND)
            assert not list(Project(root).faults()), list(Project(root).faults())
            (root / "README.md").write_text(SOUND + "\n" + planted + "\n")
            found = list(Project(root).faults())
            assert len(found) == 1 and expected in found[0] and found[0].startswith("README.md:7:"), found
    print(f"{len(PLANTED)} planted faults found")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    project = Project(Path(sys.argv[1]))
    faults = list(project.faults())
    for fault in faults:
        print(fault)
    if not faults:
        print(f"{len(project.pages)} documents keep to the tree")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
