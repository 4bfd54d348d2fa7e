#!/usr/bin/env python3
"""Fails when a Markdown page quotes an unknown `quadrille` command, option, configuration key, scene or script.

  scripts/check_commands.py PATH_TO_QUADRILLE [FOLDER]      (a part of the test `readme`; default: the source tree)
"""
import functools
import json
import os
import pathlib
import re
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT


def output(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False).stdout


@functools.cache
def help_of(*command):
    """Subcommands and options of a command."""
    text = output(*command, "--help")
    subcommands = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.M)
    return set(re.findall(r"^  (\w[\w-]*)", subcommands[1], re.M) if subcommands else ()), set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", text))


def quoted(text):
    """Commands in code spans and in code blocks, without what follows a pipe or a comment."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    spans = re.findall(r"(?<!`)`([^`]+)`(?!`)", re.sub(r"```.*?```", "", text, flags=re.S))
    lines = re.findall(r"^(?:    | *)\$? *((?:build/release/)?quadrille .*)$", text, re.M)
    for piece in [*spans, *lines]:
        for command in re.split(r"&&|;|\||  #", " ".join(piece.split())):
            words = command.split()
            if words and words[0] in ("quadrille", "build/release/quadrille") and len(words) > 1:
                yield words[1:]


def faults(words, keys, scenes):
    """What is wrong with a command."""
    command = []
    while words and words[0] in help_of(*command)[0]:
        command.append(words.pop(0))
    if not command:
        if re.fullmatch(r"[a-z]+", words[0]):
            yield f"no command {words[0]}"
        return
    for at, word in enumerate(words):
        option, _, value = word.partition("=")
        if re.match(r"--?[a-zA-Z]", word) and option not in help_of(*command)[1]:
            yield f"{' '.join(command)} has no option {option}"
        value = value or (words[at + 1] if at + 1 < len(words) else "")
        key = value.split("=")[0]
        if option in ("--set", "--axis") and re.fullmatch(r"[a-z0-9_]+", key) and key not in keys:
            yield f"{option} {key}: no such key"
        if option == "--scene" and re.fullmatch(r"[a-z0-9_]+", value) and value not in scenes:
            yield f"no scene {value}"


def main():
    keys = set(json.loads(output("config", "--json", "-"))["config"])
    scenes = {scene["name"] for scene in json.loads(output("scenes", "--json"))}
    count, wrong = 0, []
    for path in sorted(FOLDER.rglob("*.md")):
        if "build" in path.relative_to(FOLDER).parts:
            continue
        text = path.read_text(encoding="utf-8")
        for words in quoted(text):
            count += 1
            wrong += [f"{path}: `quadrille {' '.join(words)}`: {fault}" for fault in faults(list(words), keys, scenes)]
        for script in re.findall(r"(?<![\w./])(?:scripts|golden/examples|tb/verify/dpi)/[\w/]+\.(?:sh|py)\b", text):
            count += 1
            wrong += [] if (ROOT / script).exists() else [f"{path}: no {script}"]
    if wrong:
        sys.exit("\n".join(dict.fromkeys(wrong)))
    if not count:
        sys.exit(f"{FOLDER}: no page quotes a command")
    print(f"{count} quoted commands are known")


if __name__ == "__main__":
    main()
