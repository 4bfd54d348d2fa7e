"""Plans of commands that do a part of their work at a time (--shard I/N): a unit is a part, DIR/I its result, a file or a folder."""
import hashlib
import os
import pathlib
import shlex
import shutil
import sys

from report.children import NoReport, checked, processors
from report.files import InputError
from run_long import Work, new_folder


class Kind(Work):
    inside = ".run"  # beside the results

    @staticmethod
    def options(parser, table):
        parser.add_argument("--parts", type=int, default=table["parts"], metavar="N", help="number of parts (default: %(default)s)")
        parser.add_argument("words", nargs="*", metavar="OPTION", help=f"options of quadrille {table['command']}, after --")

    def plan(self):
        program = pathlib.Path(self.args.quadrille)
        return {"command": self.table["command"].split(), "options": self.args.words, "parts": self.args.parts, "program": hashlib.sha256(program.read_bytes()).hexdigest()}

    def place(self, number, directory=None):
        """Of a part: when it is whole, and until then."""
        folder, name = pathlib.Path(directory).parent if directory else pathlib.Path(self.args.out), f"{number}{self.table.get('suffix', '')}"
        return folder / name, folder / f".part.{name}"

    def begin(self, units):
        for number in units.done():
            whole, aside = self.place(number)
            if aside.exists() and units.read(number)["status"] in (0, 1):  # stopped before the renaming
                aside.rename(whole)
            if not whole.exists():  # it died, or somebody wants it anew
                os.remove(units.path(number))
        return self.args.parts

    def unit(self, number):
        whole, aside = self.place(number)
        if whole.exists():
            raise InputError(f"{whole}: is not of this run; remove it or use another folder")
        if not self.table.get("resumes"):
            shutil.rmtree(aside, ignore_errors=True)
        threads = ["--threads", str(max(1, processors() // self.args.jobs))]
        part = self.table.get("part", "--shard {number}/{parts}").format(number=number, parts=self.args.parts).split()
        command = [self.args.quadrille, *self.table["command"].split(), *self.args.words, *part, *threads, "--quiet", self.table["result"], str(aside)]
        try:
            return {"status": checked(command, silent=range(2, 256)).returncode}
        except NoReport as fault:
            return {"status": str(fault)}

    def told(self, number, result):
        whole, aside = self.place(number)
        if dead := isinstance(result["status"], str):  # no result: the next run does it again
            print(f"FAILED: {whole}: {result['status']}", file=sys.stderr, flush=True)
        else:
            aside.rename(whole)
            print(f"{whole}: status {result['status']}", flush=True)
        return dead

    def merge(self, directory, shards):
        if not self.table.get("merge"):
            raise InputError("parts of this plan cannot be merged")
        places = {number: self.place(number, shards.parts[number].directory)[0] for number in shards.done()}
        missing = [number for number in range(shards.plan["parts"]) if number not in places or not places[number].exists()]
        if missing:
            raise InputError(f"part {missing[0]} of {shards.plan['parts']} is missing")
        new_folder(directory)
        parts = map(str, places.values())
        words = self.table["merge"].format(options=shlex.join(shards.plan["options"]), parts=shlex.join(parts))
        result = checked([self.args.quadrille, *shlex.split(words), "--quiet", self.table["result"], directory], silent=range(2, 256))
        sys.stderr.write(result.stderr)
        return result.returncode == 0

    def report(self, runs):
        good = True
        for shards in runs:
            failed = [number for number in shards.done() if shards.read(number)["status"] != 0]
            good = good and not failed and bool(shards.done())
            print(f"{' '.join(shards.directories)}: {len(shards.done())} of {shards.plan['parts']} parts of quadrille "
                  f"{shlex.join(shards.plan['command'] + shards.plan['options'])}, {len(failed)} failed" + "".join(f" {number}" for number in failed))
        return good
