"""Reading what the program wrote, and writing all of a report or none of it."""
import contextlib
import csv
import json
import math
import os


class Failed(Exception):
    """What was to be done failed: exit status 1."""
    status = 1


class InputError(Failed):
    """Bad input or output: the message names the file and what would be right."""
    status = 2


class MissingTool(InputError):
    """A fault of the environment."""
    status = 3


@contextlib.contextmanager
def reading(path, writer):
    """Whatever is wrong with the file becomes an InputError with its name and the command that writes it."""
    try:
        yield
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}; {writer} writes it") from None
    except KeyError as error:
        raise InputError(f"{path}: no {error}; {writer} writes it") from None
    except (ValueError, TypeError, IndexError, AttributeError, EOFError, RecursionError, csv.Error) as error:
        raise InputError(f"{path}: {error}; {writer} writes it") from None


def read_json(path):
    """JSON without NaN."""
    def refuse(name):
        raise ValueError(f"{name} is not a number")

    with open(path, encoding="utf-8") as file:
        return json.load(file, parse_constant=refuse)


def read_report(path):
    """A report of the program."""
    report = read_json(path)
    if report["schema_version"] != 1:
        raise ValueError(f"schema_version is {report['schema_version']}, this script reads 1")
    return report


def read_columns(path, required):
    """Cells of a CSV file by column."""
    with open(path, encoding="utf-8", newline="") as file:
        text = file.read()
    if not text.endswith("\n"):
        raise ValueError("its last line is cut off")
    head, *lines = csv.reader(text.splitlines(), strict=True)
    for name in required:
        if head.count(name) != 1:
            raise ValueError(f"no column {name}" if name not in head else f"{name} is there twice")
    for number, line in enumerate(lines, 2):
        if len(line) != len(head):
            raise ValueError(f"line {number}: {len(line)} cells instead of {len(head)}")
    return {name: [line[i] for line in lines] for i, name in enumerate(head)}


def numbers(name, cells):
    """Doubles; NaN where a cell is empty."""
    values = []
    for line, cell in enumerate(cells, 2):
        try:
            values.append(float(cell) if cell else math.nan)
        except ValueError:
            raise ValueError(f"line {line}: {name} is '{cell}', not a number") from None
    return values


def write_text(path, text):
    """A file, whole or not at all."""
    write_files(os.path.dirname(os.path.abspath(path)), {os.path.basename(path): text.encode()})


def write_files(directory, files):
    """Files by name, as bytes: all beside their places first, then renamed."""
    aside = {os.path.join(directory, name): os.path.join(directory, f".{name}.{os.getpid()}.tmp") for name in files}
    path = directory
    try:
        os.makedirs(directory, exist_ok=True)
        for path, data in zip(aside, files.values()):
            with open(aside[path], "wb") as file:
                file.write(data)
        for path in aside:
            os.replace(aside[path], path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    finally:
        for temporary in aside.values():
            with contextlib.suppress(OSError):
                os.remove(temporary)
