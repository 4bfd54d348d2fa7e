#!/usr/bin/env python3
"""Long work in numbered units of a plan. After a stop the same command resumes.

  scripts/run_long.py PLAN --out DIR
  scripts/run_long.py PLAN --shard 0/4 --out A
  scripts/run_long.py PLAN --merge A B C D --out W      the bytes of one run
  scripts/run_long.py PLAN --status A B C D             sums; writes nothing

PLAN is a TOML file or a name in scripts/plans/; PLAN --help has its options.
  DIR/plan.json             the plan; another plan is refused
  DIR/units/00000042.json   result of a unit, complete or absent
  DIR/times.jsonl           seconds per unit

SIGTERM, SIGINT and SIGHUP stop the running units; finished units are kept. A
crash of the program is kept as a fault of its unit. A unit killed from outside
is reported and rerun.

Exit status: 0 no fault, 1 a fault, a lost unit or too little compared, 2 usage
or input error, 3 missing tool, 130 stopped.
"""
import argparse
import concurrent.futures
import contextlib
import fcntl
import importlib
import itertools
import json
import os
import pathlib
import re
import sys
import tempfile
import textwrap
import time
import tomllib

from report.children import CHILDREN, Lost, Stopped, processors  # noqa: E402
from report.files import InputError, read_json, write_files  # noqa: E402
from report.program import PROGRAM, ROOT, options, usage  # noqa: E402

sys.path.append(ROOT)  # kinds of plans are modules of scripts/ and of the tree
PLANS = pathlib.Path(__file__).resolve().parent / "plans"
SILENT = 100  # units on end without a report, after which a run ends: the program does nothing else


# ---- Folders of units ----


def text(value):
    return json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n"


def shard(word):
    """(i, n) of "i/n", 0 <= i < n; for argparse."""
    match = re.fullmatch(r"(\d+)/(\d+)", word)
    if not match or not int(match[1]) < int(match[2]):
        raise argparse.ArgumentTypeError(f"'{word}': I/N with 0 <= I < N is expected")
    return int(match[1]), int(match[2])


class Units:
    """A folder of units done. `plan` is that of a new one; what is there must have the same. None: it must be there."""

    def __init__(self, directory, plan=None):
        self.directory, self.folder = directory, os.path.join(directory, "units")
        path = os.path.join(directory, "plan.json")
        if plan is not None and not os.path.exists(path):
            write_new(directory, path, text(plan))
        try:
            self.plan = dict(read_json(path))
        except FileNotFoundError:
            raise InputError(f"{path}: no such file; the folder of a run is expected") from None
        except (OSError, ValueError, TypeError) as error:
            raise InputError(f"{path}: {error}; give another folder") from None
        if plan is not None:
            same_plan(path, self.plan, json.loads(text(plan)))

    @contextlib.contextmanager
    def locked(self, part=(0, 1)):
        """Keeps other processes from writing here; those of other shards may."""
        with contextlib.ExitStack() as files:
            for name, kind in ((".lock", fcntl.LOCK_SH if part[1] > 1 else fcntl.LOCK_EX), (".lock.{}.{}".format(*part), fcntl.LOCK_EX)):
                try:
                    fcntl.flock(files.enter_context(open(os.path.join(self.directory, name), "w", encoding="utf-8")), kind | fcntl.LOCK_NB)
                except OSError:
                    raise InputError(f"{self.directory}: another process is writing there; wait, or give each shard a folder") from None
            yield

    def done(self):
        """Numbers of the units done, in order."""
        names = os.listdir(self.folder) if os.path.isdir(self.folder) else []
        return sorted(int(match[1]) for match in map(re.compile(r"(\d{8})\.json").fullmatch, names) if match)

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

    def run(self, do, numbers, jobs=1, until=None, told=lambda number, result: None, part=(0, 1)):
        """Does those of `numbers` that are missing, `jobs` at a time, until they or the seconds `until` (of time.monotonic) are over, and
        tells of each on this thread: its result, or that it was Lost. Another exception of a unit ends the run when the others under way are
        over, and kept where they are done. Whether no unit was lost."""
        with self.locked(part), open(os.path.join(self.directory, "times.jsonl"), "a", encoding="utf-8") as times, \
                concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            done = set(self.done())
            missing = (number for number in numbers if number not in done)
            running, failed, whole = {}, None, True
            while True:
                free = jobs - len(running) if not failed and (until is None or time.monotonic() < until) else 0
                for number in itertools.islice(missing, free):
                    running[pool.submit(do, number)] = (number, time.monotonic())
                if not running:
                    break
                for future in concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED).done:
                    number, began = running.pop(future)
                    error = future.exception()
                    if isinstance(error, Lost):
                        whole = False
                        told(number, error)
                    elif error:
                        failed = failed or error
                    else:
                        self.write(number, future.result())
                        times.write("\n" + json.dumps({"unit": number, "seconds": round(time.monotonic() - began, 3)}))  # after a line cut off too
                        times.flush()
                        told(number, future.result())
            if failed:
                raise failed
            return whole


def write_new(directory, path, data):
    """A file that is there whole, unless another shard has written it."""
    try:
        os.makedirs(directory, exist_ok=True)
        if set(os.listdir(directory)) - {"plan.json", "units", "times.jsonl"} - {name for name in os.listdir(directory) if name.startswith(".")}:
            raise InputError(f"{directory}: holds something else; a new folder, or that of a run, is expected")
        with tempfile.NamedTemporaryFile("w", dir=directory, prefix=".plan.") as file, contextlib.suppress(FileExistsError):
            file.write(data)
            file.flush()
            os.chmod(file.name, 0o644)
            os.link(file.name, path)
    except OSError as error:
        raise InputError(f"{directory}: cannot be written ({error.strerror})") from None


def same_plan(path, there, wanted):
    for key in sorted(set(there) | set(wanted), key=lambda key: (len(str(wanted.get(key))), key)):  # short ones say more
        if there.get(key) != wanted.get(key):
            raise InputError(f"{path}: {key} is {there.get(key)}, not {wanted.get(key)}; the run there can go on with its own alone")


class Shards:
    """The units of several folders of one plan, as Units has them. The same unit in two of them must be the same."""

    def __init__(self, sources):
        parts = [Units(source) for source in sources]
        self.directories, self.plan, self.parts, self.times = list(sources), parts[0].plan, {}, {}
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


def new_folder(directory):
    if os.path.exists(directory) and (not os.path.isdir(directory) or os.listdir(directory)):
        raise InputError(f"{directory}: is there already; a new folder is expected")


def merge(directory, shards):
    """A new folder with the units of all."""
    new_folder(directory)
    whole = Units(directory, shards.plan)
    with whole.locked():
        for number in shards.done():
            whole.write(number, shards.read(number))
        lines = "".join("\n" + json.dumps({"unit": number, "seconds": took}) for number, took in sorted(shards.seconds().items()))
        write_files(directory, {"times.jsonl": lines.encode()})


def runs_of(directories):
    """The folders of each plan together, by the plan's text."""
    plans = {}
    for directory in directories:
        plans.setdefault(text(Units(directory).plan), []).append(directory)
    return [Shards(of_one) for of_one in plans.values()]


# ---- A run ----


class Work:
    """What a kind of plan adds to the runner. `table` is the plan's TOML file; `inside`: where in a run's folder its units are."""
    inside = "."

    def __init__(self, args, table):
        self.args, self.table = args, table

    @staticmethod
    def options(parser, table):
        """Adds the plan's own options."""

    def plan(self):
        """What all units follow from."""
        raise NotImplementedError

    def begin(self, units):
        """Before any unit is timed. How many units there are; None: without end."""

    def unit(self, number):
        """The result of a unit."""
        raise NotImplementedError

    def told(self, number, result):
        """Says what came of a unit that is kept. Whether the program made no report in it."""

    def merge(self, directory, shards):
        merge(directory, shards)
        return True

    def report(self, runs):
        """Prints the sums. Whether all is as it should be."""
        raise NotImplementedError


def work_on(work, units):
    """Does units until the time is over or all are done. Whether none was lost."""
    args, silent = work.args, 0
    count = min((n for n in (work.begin(units), args.units) if n is not None), default=None)
    until = None if args.hours is None else time.monotonic() + 3600 * args.hours

    def numbers():
        for number in range(args.shard[0], count, args.shard[1]) if count is not None else itertools.count(*args.shard):
            if silent >= SILENT:
                break
            yield number

    def told(number, result):
        nonlocal silent
        lost = isinstance(result, Lost)
        if lost:
            print(f"FAILED: unit {number}: {result}; not kept, the next run does it again", file=sys.stderr, flush=True)
        silent = silent + 1 if lost or work.told(number, result) else 0

    whole = units.run(work.unit, numbers(), args.jobs, until, told, args.shard)
    if silent >= SILENT:
        print(f"FAILED: ended after {silent} units on end without a report", file=sys.stderr)
    return whole


def common_options(parser, table):
    parser.add_argument("--out", metavar="DIR", help="folder of the run (default: %(default)s)", default=table.get("out") and os.path.join(ROOT, table["out"]))
    parser.add_argument("--shard", type=shard, default=(0, 1), metavar="I/N", help="only units I, I + N, …; 0 <= I < N")
    parser.add_argument("--jobs", type=int, metavar="N", default=table.get("jobs") or processors(), help="parallel units (default: %(default)s)")
    parser.add_argument("--hours", type=float, metavar="H", help="stop after this time; running units finish")
    parser.add_argument("--units", type=int, metavar="N", help="stop after the first N units")
    parser.add_argument("--seed", type=int, default=1, help="seed of all random choices (default: 1)")
    parser.add_argument("--merge", nargs="+", metavar="DIR", help="join shards into --out")
    parser.add_argument("--status", nargs="+", metavar="DIR", help="only report sums of runs or shards")
    parser.add_argument("--quadrille", metavar="PATH", default=PROGRAM, help="program (default: build/release/quadrille)")


def check_options(parser, args, table):
    for name, least in (("jobs", 1), ("units", 1), ("limit", 1), ("machines", 0), ("parts", 1)):
        if (value := getattr(args, name, None)) is not None and value < least:
            parser.error(f"--{name} {value}: expected at least {least}")
    if args.hours is not None and not args.hours > 0:
        parser.error(f"--hours {args.hours}: expected more than 0")
    if args.status is None and args.merge is None:
        if not os.access(args.quadrille, os.X_OK):
            parser.error(f"--quadrille {args.quadrille}: not found; scripts/setup.sh builds it")
        if table.get("endless") and args.hours is None and args.units is None:
            parser.error("expected --hours or --units, --status DIR, or --merge DIR… --out DIR")
    if args.merge and args.out == parser.get_default("out") or args.shard[1] > 1 and args.out is None:
        parser.error("--shard and --merge need a folder: --out DIR")


def read_plan(name):
    path = pathlib.Path(name) if name.endswith(".toml") else PLANS / f"{name}.toml"
    try:
        return {"name": path.stem} | tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        sys.exit(f"{path}: {error}; expected a plan such as those in {PLANS}")


def do(work):
    """What the options say. The exit status."""
    args = work.args
    CHILDREN.stop_at_signals()
    try:
        def units_in(folders):
            return [os.path.normpath(os.path.join(folder, work.inside)) for folder in folders]

        if args.status:
            return 0 if work.report(runs_of(units_in(args.status))) else 1
        if args.merge:
            shards = Shards(units_in(args.merge))
            good = work.merge(args.out, shards)
            return 0 if work.report([shards]) and good else 1
        with contextlib.nullcontext(args.out) if args.out else tempfile.TemporaryDirectory() as folder:
            units = Units(units_in([folder])[0], work.plan())
            whole = work_on(work, units)
            return 0 if work.report(runs_of([units.directory])) and whole else 1
    except InputError as error:
        print(f"{work.table['name']}: {error}", file=sys.stderr)
        return error.status
    except Stopped:
        print("stopped" + ("; finished units are kept, the same command resumes" if args.out else ""), file=sys.stderr)
        return 130


def main(name, arguments):
    table = read_plan(name)
    kind = importlib.import_module(table["kind"]).Kind
    parser = options(f"{textwrap.fill(table['about'], 80)}\n\n{__doc__}", prog=table["name"])
    common_options(parser, table)
    kind.options(parser, table)
    args = parser.parse_args(arguments)
    work = kind(args, table)
    check_options(parser, args, table)
    return do(work)


if __name__ == "__main__":
    usage(__doc__, len(sys.argv) > 1)
    import run_long  # as the kinds do
    sys.exit(run_long.main(sys.argv[1], sys.argv[2:]))
