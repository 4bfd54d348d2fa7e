"""Long work in numbered units, each a function of a plan and its number: a folder keeps the plan and the result of every unit done.

A run that was stopped goes on with the units that are missing. Shards i of n do the units i, i + n, i + 2n, …; their folders put
together hold the bytes that one run would have left, for nothing in a result tells when, where or in which order it came about.
Times are kept apart (times.jsonl).

    plan.json            what all units follow from
    units/00000042.json  the result of one of them, there whole or not at all
    times.jsonl          seconds of each, as they ended
"""
import argparse
import concurrent.futures
import contextlib
import fcntl
import json
import os
import re
import time

from report.files import InputError, read_json, write_files

UNIT_NAME = re.compile(r"(\d{8})\.json")


def text(value):
    return json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n"


def shard(word):
    """(i, n) of "i/n", 0 <= i < n; for argparse."""
    match = re.fullmatch(r"(\d+)/(\d+)", word)
    if not match or not int(match[1]) < int(match[2]):
        raise argparse.ArgumentTypeError(f"'{word}': I/N with 0 <= I < N is expected")
    return int(match[1]), int(match[2])


class Lost(Exception):
    """Of a unit that something else ended: it is not kept, and the next run does it again."""


class Units:
    """A folder of units done. `plan` is that of a new one; what is there must have the same. None: it must be there. `defaults`: values of the
    keys that plans did not have once."""

    def __init__(self, directory, plan=None, defaults=None):
        self.directory = directory
        path = os.path.join(directory, "plan.json")
        if os.path.exists(path):
            try:
                self.plan = {**(defaults or {}), **read_json(path)}
            except (OSError, ValueError, TypeError) as error:
                raise InputError(f"{path}: {error}; give another folder") from None
            if plan is not None:
                same_plan(path, self.plan, plan)
        elif plan is None:
            raise InputError(f"{path}: no such file; the folder of a run is expected")
        elif os.path.isdir(directory) and os.listdir(directory):
            raise InputError(f"{directory}: holds something else; a new folder, or that of a run, is expected")
        else:
            self.plan = plan
            write_files(directory, {"plan.json": text(plan).encode()})
        self.folder = os.path.join(directory, "units")

    def locked(self):
        """An open file that keeps other processes from writing here."""
        lock = open(os.path.join(self.directory, ".lock"), "w", encoding="utf-8")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            raise InputError(f"{self.directory}: another process is writing there; wait, or give each shard a folder") from None
        return lock

    def done(self):
        """Numbers of the units done, in order."""
        names = os.listdir(self.folder) if os.path.isdir(self.folder) else []
        return sorted(int(match[1]) for match in map(UNIT_NAME.fullmatch, names) if match)

    def path(self, number):
        return os.path.join(self.folder, f"{number:08}.json")

    def read(self, number):
        try:
            return read_json(self.path(number))
        except (OSError, ValueError) as error:
            raise InputError(f"{self.path(number)}: {error}; remove it and run on") from None

    def write(self, number, result):
        write_files(self.folder, {os.path.basename(self.path(number)): text(result).encode()})

    def seconds(self):
        """Of the units whose time was kept, by number. A line that a stop cut off counts for nothing."""
        times = {}
        with contextlib.suppress(FileNotFoundError), open(os.path.join(self.directory, "times.jsonl"), encoding="utf-8") as file:
            for line in file:
                with contextlib.suppress(ValueError):
                    entry = json.loads(line)
                    times[entry["unit"]] = entry["seconds"]
        return times

    def run(self, do, numbers, jobs=1, until=None, told=lambda number, result: None):
        """Does those of `numbers` that are missing, `jobs` at a time, until they or the seconds `until` (of time.monotonic) are over, and
        tells of each on this thread: its result, or that it was Lost. Another exception of a unit ends the run when the others under way are
        over, and kept where they are done. Whether no unit was lost."""
        with self.locked():
            done = set(self.done())
            missing = (number for number in numbers if number not in done)
            with open(os.path.join(self.directory, "times.jsonl"), "a", encoding="utf-8") as times, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
                running = {}
                failed, whole = None, True
                while True:
                    while len(running) < jobs and not failed and (until is None or time.monotonic() < until):
                        number = next(missing, None)
                        if number is None:
                            break
                        running[pool.submit(do, number)] = (number, time.monotonic())
                    if not running:
                        break
                    ended, _ = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
                    for future in ended:
                        number, began = running.pop(future)
                        if isinstance(future.exception(), Lost):
                            whole = False
                            told(number, future.exception())
                            continue
                        if future.exception():
                            failed = failed or future.exception()
                            continue
                        self.write(number, future.result())
                        times.write("\n" + json.dumps({"unit": number, "seconds": round(time.monotonic() - began, 3)}))  # after a line cut off too
                        times.flush()
                        told(number, future.result())
                if failed:
                    raise failed
                return whole


def same_plan(path, there, wanted):
    for key in sorted(set(there) | set(wanted), key=lambda key: (len(str(wanted.get(key))), key)):  # short ones say more
        if there.get(key) != wanted.get(key):
            raise InputError(f"{path}: {key} is {there.get(key)}, not {wanted.get(key)}; the run there can go on with its own alone")


class Shards:
    """The units of several folders of one plan, as Units has them. The same unit in two of them must be the same."""

    def __init__(self, sources, defaults=None):
        parts = [Units(source, defaults=defaults) for source in sources]
        self.directories = list(sources)
        self.plan = parts[0].plan
        self.parts = {}
        self.times = {}
        for part in parts:
            same_plan(os.path.join(part.directory, "plan.json"), part.plan, self.plan)
            for number in part.done():
                other = self.parts.setdefault(number, part)
                if other is not part and part.read(number) != other.read(number):
                    raise InputError(f"{part.path(number)}: differs from {other.path(number)}, where the same was expected")
            self.times = part.seconds() | self.times

    def done(self):
        return sorted(self.parts)

    def read(self, number):
        return self.parts[number].read(number)

    def seconds(self):
        return self.times


def merge(directory, sources, defaults=None):
    """A new folder with the units of all."""
    shards = Shards(sources, defaults)
    if os.path.exists(directory) and os.listdir(directory):
        raise InputError(f"{directory}: is there already; a new folder is expected")
    whole = Units(directory, shards.plan)
    with whole.locked():
        for number in shards.done():
            whole.write(number, shards.read(number))
        seconds = shards.seconds()
        lines = "".join("\n" + json.dumps({"unit": number, "seconds": seconds[number]}) for number in sorted(seconds))
        write_files(directory, {"times.jsonl": lines.encode()})
    return whole
