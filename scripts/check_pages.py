#!/usr/bin/env python3
"""Fails unless the Markdown pages name all that a user meets, quote only what exists, link, and stay short.

  scripts/check_pages.py PATH_TO_QUADRILLE

A name counts in `code`; `{a,b}_c` names a_c and b_c, and N stands for a number in a name. Names come from the program, the sources, and files
that the program writes: a new one needs no change here."""
import concurrent.futures
import csv
import functools
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

from report.program import usage

usage(__doc__, len(sys.argv) == 2)
PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(__file__).resolve().parent.parent
PAGES = {p: p.read_text(encoding="utf-8") for p in sorted(ROOT.rglob("*.md")) if p.relative_to(ROOT).parts[0] != "build"}
LINES = {"README.md": 120, "tb/DECIDE.md": 120, "rtl/INTEGRATE.md": 120, "golden/EXPLORE.md": 120, "rtl/REJECTED.md": 100}
COLUMNS, README_LINES, WORDS = 120, 200, 27_000
APART = (
    "rtl/SPEC.md", "golden/CHANGELOG.md", "golden/explain/README.md", "model/page/README.md",
    "model/python/README.md", "rtl/configurations/README.md", "rtl/demo/README.md", "rtl/triangles/README.md", "rtl/wrap/README.md",
    "tb/verify/cocotb/README.md", "scripts/MATRIX.md")
INPUT = "--scene bowtie --size 16x16"
RUNS = f"""config --json @.json|export --out @ --json @.json|scenes --json @.json|scenes --corner --json @.json|scenes --stress --json @.json|cache --json @.json
explain {INPUT} --pixel 3,2 --json @.json|fragments {INPUT} --out @.csv|fragments {INPUT} --errors --out @.csv --json @.json|render {INPUT} --png @.png --json @.json
render --mesh {ROOT}/golden/examples/box.obj --size 16x16 --png @.png --save-camera @.json|bench --no-rtl --repeat 1 --fragments 1000 --json @.json
bench --error --no-rtl --repeat 1 {INPUT} --json @.json|bench --skips --no-rtl --repeat 1 {INPUT} --json @.json
compare {INPUT} --methods mvc --reference mvc --repeats 1 --crease-sizes 16 --out @|stress --families sliver --count 1 --csv @.csv --json @.json
sweep --axis significand_bits=12,14 {INPUT} --cosim none --out @|golden generate --suite sqrt --suite machine --limit 4 --out @ --json @.json"""


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, text=True, check=True).stdout


def text_of(*patterns):
    return {p: p.read_text(encoding="utf-8") for pattern in patterns for p in sorted(ROOT.glob(pattern)) if "_test." not in p.name}


KEYS = json.loads(run("config", "--json", "-"))["config"]
SCENES = {scene["name"] for scene in json.loads(run("scenes", "--json"))}
SCRIPTS = text_of("scripts/*.py", "scripts/*.sh", "scripts/report/*.py", "scripts/plans/*.toml", "tb/verify/*/*.py")
PLANS = [tomllib.loads(text) for path, text in SCRIPTS.items() if path.suffix == ".toml"]


@functools.cache
def help_of(*command):
    """Commands and options of a command."""
    text = run(*command, "--help")
    commands = re.search(r"^(?:Subc|C)ommands:\n((?:  .*\n)+)", text, re.M)
    heads = " ".join(re.findall(r"^  (-.*?)(?: [^-]|\{|$)", text, re.M))
    return re.findall(r"^  (\w[\w-]*)", commands[1], re.M) if commands else [], set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", heads))


def all_commands(*command):
    yield command
    for sub in help_of(*command)[0]:
        yield from all_commands(*command, sub)


def code_of(text):
    """Code spans and blocks of a page."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    rest = re.sub(r"```.*?```", "", text, flags=re.S)
    return re.findall(r"(?<!`)`([^`]+)`(?!`)", rest), re.findall(r"```.*?```", text, re.S) + re.findall(r"^    .*$", rest, re.M)


def names_in(pieces):
    names = set()
    for word in " ".join(pieces).split():
        groups = [group[1:-1].split(",") if group.startswith("{") else [group] for group in re.split(r"(\{[^{}]*,[^{}]*\})", word)]
        for whole in map("".join, itertools.product(*groups)):
            for name in re.findall(r"-{0,2}\w[\w-]*(?:\.\w+)*", whole):
                names |= {name, *name.split(".")}
    return names


def keys_of(value):
    """Names of fields; a key with another sign, or in a record of a boundary (`explain`), is a name of data."""
    if isinstance(value, dict):
        yield from (re.sub(r"_\d+$", "_N", key) for key in value if re.fullmatch(r"[A-Za-z]\w*", key))
    inside = [v for k, v in value.items() if k not in ("stored", "other")] if isinstance(value, dict) else value
    for child in inside if isinstance(value, (dict, list)) else ():
        yield from keys_of(child)


def plan_keys(table):
    """Keys of a plan, without names of phases and forms."""
    for key, value in table.items():
        yield key
        if isinstance(value, dict) and all(isinstance(child, dict) for child in value.values()):
            yield from itertools.chain.from_iterable(map(plan_keys, value.values()))


def fields_of_runs():
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        commands = [command.replace("@", f"{folder}/{i}").split() for i, command in enumerate(re.split(r"[|\n]", RUNS))]
        list(pool.map(lambda command: run(*command), commands))
        for path in pathlib.Path(folder).rglob("*.*"):
            if path.suffix == ".json":
                yield from keys_of(json.loads(path.read_text(encoding="utf-8")))
            elif path.suffix == ".csv":
                yield from keys_of(dict.fromkeys(next(csv.reader(path.open(encoding="utf-8")))))


def fields_in_sources():
    """Those of runs that take long, need a simulator or must fail, too."""
    for text in text_of("tb/commands/*.cpp", "tb/studies/*.cpp", "golden/vectors/*.cpp").values():
        if indexed := re.findall(r'(?<!result)\["([a-z]\w*)"\](?=(?:\[.*?\])* =|\.push_back|\.update)', text):
            yield from indexed + re.findall(r'\{"([a-z]\w*)", (?=[\w:.]+[^"\w])', text)


@functools.cache
def script_options(path):
    """Options of a script and of the scripts, modules and plans that it names."""
    texts, todo = {}, [path]
    while todo:
        path = todo.pop()
        text = texts[path] = path.read_text(encoding="utf-8")
        todo += [p for p in SCRIPTS if re.search(rf"(?:import |report\.|faults\.|/){'plans' if p.suffix == '.toml' else p.stem}\b", text) and p not in texts]
    text = "\n".join(texts.values())
    found = re.findall(r"""add_argument\("(--?\w[\w-]*)"(?:, "(--\w[\w-]*)")?|^ *(?:"" \| )?(--\w[\w-]*(?: \| --\w[\w-]*)*)\)|= (--\w[\w-]*) \]""", text, re.M)
    looped = re.findall(r'for \w+ in \((.*)\):\n *parser.add_argument\(f"--\{', text) + re.findall(r"^\[form\.(\w+)\]", text, re.M)
    return set(re.findall(r"--?\w[\w-]*", " ".join(map(" ".join, found)))) | {f"--{name}" for name in re.findall(r"\w+", " ".join(looped))}


def wanted():
    """(kind, names, whether a command in a page names them)."""
    yield "configuration keys", KEYS, False
    commands = list(all_commands())
    yield "commands", {word for command in commands for word in command}, True
    yield "options", set().union(*(help_of(*command)[1] for command in commands)), True
    typed = [p for p in SCRIPTS if p.parent.name == "scripts" and not p.name.startswith("check_")]
    yield "scripts", {path.name for path in typed}, True
    yield "options of scripts", set().union(*map(script_options, typed)), True
    for module in ("rtl/quadrille.sv", "rtl/wrap/quadrille_axi4_stream.sv"):
        header = re.search(r"^module .*?^\);", (ROOT / module).read_text(encoding="utf-8"), re.M | re.S)[0]
        yield f"ports and parameters of {module}", re.findall(r"(?:input|output|localparam|parameter) .*?(\w+)(?: =.*)?,?$", header, re.M), False
    yield "keys of plans", {*itertools.chain.from_iterable(map(plan_keys, PLANS))}, False
    yield "metrics of cosim", {n for name in re.findall(r"^\| `([\w.]+)`", run("cosim", "--list-metrics"), re.M) for n in name.split(".")}, False
    yield "fields that runs write", set(fields_of_runs()), False
    yield "fields in the sources", set(fields_in_sources()), False


def quoted(spans, blocks):
    """Quoted commands, without what follows a pipe, a comment or a `--`."""
    lines = re.sub(r"\\\n", " ", "\n".join(blocks)).splitlines()
    for piece in [*spans, *(re.sub(r"^(?: |\$ )*", "", line) for line in lines)]:
        for command in re.split(r"&&|;|\||  #| -- |\$\(", " ".join(piece.split(" #")[0].split())):
            if re.match(r" *(?:build/release/)?quadrille \S| *(?:scripts|golden|tb|rtl)/[\w/]+\.(?:sh|py)\b", command):
                yield command.split()


def faults(program, *words):
    """What is wrong with a quoted command."""
    words, command = list(words), []
    if script := program.endswith((".sh", ".py")):
        if not (path := ROOT / program).exists():
            yield "no such script"
            return
        known = script_options(path) | {"--help"} | {"cosim.sh": help_of("cosim")[1], "test.sh": {"-R", "-L"}}.get(path.name, set())
    else:
        while words and words[0] in help_of(*command)[0]:
            command.append(words.pop(0))
        if not command and re.fullmatch(r"[a-z]+", words[0]):
            yield f"no command {words[0]}"
        known = help_of(*command)[1]
    for word, after in zip(words, [*words[1:], ""]):
        option, _, value = word.partition("=")
        if re.match(r"--?[a-zA-Z]", word) and option not in known and (command or script):
            yield f"no option {option}"
        value = value or after
        key = value.split("=")[0]
        if option in ("--set", "--axis") and re.fullmatch(r"[a-z0-9_]+", key) and key not in KEYS:
            yield f"{option} {key}: no such key"
        if option == "--scene" and re.fullmatch(r"[a-z0-9_]+", value) and value not in SCENES:
            yield f"no scene {value}"


def without_help(scripts):
    """Scripts whose --help does not end at once, well and with what it says."""
    def ask(path):
        try:
            asked = subprocess.run([path, "--help"], capture_output=True, timeout=60, check=False)
        except subprocess.TimeoutExpired:
            return "goes on"
        return "" if asked.returncode == 0 and asked.stdout and not asked.stderr else f"status {asked.returncode}"

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [f"{path} --help: {fault}" for path, fault in zip(scripts, pool.map(ask, scripts)) if fault]


def slugs(text):
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", h).lower()).strip().replace(" ", "-") for h in re.findall(r"^#+ (.*)$", text, re.M)}


def prose(text):
    """Numbered lines outside of code, tables, comments and generated text."""
    text = re.sub(r"^<!-- [^\n]* -->\n((?!<!-- )[^\n]*\n)*<!-- end -->|<!--.*?-->|```.*?```", lambda match: "\n" * match[0].count("\n"), text, flags=re.M | re.S)
    return [(number, line) for number, line in enumerate(text.splitlines(), 1) if not line.startswith(("|", "    "))]


def main():
    wrong, commands, spans, blocks, lines, links = [], [], [], [], [], {}

    def judge(what, found, faulty):
        print(f"{len(found)} {what}")
        wrong.extend(faulty if found else [f"{what}: none found"])

    for path, text in PAGES.items():
        code = code_of(text)
        spans, blocks = spans + code[0], blocks + code[1]
        commands += [(path, command) for command in quoted(*code)]
        lines += [(path, *line) for line in prose(text)]
        links[path] = [(link, (path.parent / link[0]).resolve() if link[0] else path, link[1])
                       for link in re.findall(r"\]\((?!\w+:)([^)#\s]*)#?([^)\s]*)\)", re.sub(r"```.*?```|`[^`]*`", "", text, flags=re.S))]
    in_span, in_code = names_in(spans), names_in(spans + blocks)
    for kind, names, anywhere in wanted():
        judge(kind, names, [f"{kind}: no page names `{name}`" for name in sorted(names) if name not in (in_code if anywhere else in_span)])
    statuses = re.findall(r"exit_\w+ = (\d+)", (ROOT / "tb/support/errors.hpp").read_text(encoding="utf-8"))
    sentence = re.search(r"Exit\s+status:([^.]*)", PAGES[ROOT / "README.md"])[1]
    judge("exit statuses", statuses, [f"README.md: no exit status {s}" for s in statuses if not re.search(rf"\b{s} \w", sentence)])
    judge("quoted commands", commands, [f"{path}: `{' '.join(words)}`: {fault}" for path, words in commands for fault in faults(*words)])

    # cosim.sh builds the program that prints its help.
    scripts = [path for path in SCRIPTS if os.access(path, os.X_OK) and path.name != "cosim.sh"]
    judge("scripts with --help", scripts, without_help(scripts))

    found = [(path, *link) for path, of_page in links.items() for link in of_page]
    judge("relative links", found, [f"{path}: dead link {link}" for path, link, target, heading in found
                                    if not target.exists() or heading and heading not in slugs(PAGES.get(target, ""))])
    reached = {ROOT / "README.md"}
    for _ in range(2):
        reached |= {target / "README.md" if target.is_dir() else target for page in reached for _, target, _ in links.get(page, ())}
    judge("pages within two clicks", reached & set(PAGES), [f"{path}: more than two clicks from README.md" for path in PAGES if path not in reached])

    judge(f"lines of prose, {COLUMNS} columns at most", lines, [f"{path}:{number}: {len(line)} columns" for path, number, line in lines if len(line) > COLUMNS])
    limits = {ROOT / name: LINES.get(name, README_LINES) for name in {*LINES, *(str(p.relative_to(ROOT)) for p in PAGES if p.name == "README.md")}}
    judge("pages of limited lines", limits, [f"{path}: {n} lines; at most {limits[path]}" for path in limits
                                             if not 0 < (n := len(PAGES.get(path, "").splitlines())) <= limits[path]])
    words = {path: len(text.split()) for path, text in PAGES.items()}
    apart = {name: words.pop(ROOT / name) for name in APART}
    judge(f"pages of {sum(words.values())} words; {apart}", words, [f"more than {WORDS} words"] * (sum(words.values()) > WORDS))
    sys.exit("\n".join(dict.fromkeys(str(fault).replace(f"{ROOT}/", "") for fault in wrong)) or 0)


if __name__ == "__main__":
    main()
