#!/usr/bin/env python3
"""Proves properties of the RTL with Yosys and z3, a line per proof of proofs.toml.

  scripts/prove.py --tier default
  scripts/prove.py --only NAME
  scripts/prove.py --faults --count N

Kinds of proof (tb/verify/formal/README.md):
  induction  always: `depth` clocks from reset, then one clock more by induction
  pipeline   always: `depth` clocks after any register contents
  bounded    `depth` clocks from reset
With --tier all, an induction with `bounded` also runs for that many clocks.

--faults puts each recorded fault (tb/verify/faults/faults.py) into a copy of
the RTL. The proof must then give a counterexample.

Exit status: 0 all proved or all faults found, 1 not, 2 usage error,
3 missing tool.
"""
import argparse
import concurrent.futures
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tb", "verify", "faults"))
import faults as registry  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FORMAL = os.path.join(ROOT, "tb", "verify", "formal")
KINDS = ("induction", "pipeline", "bounded")
TOOLS = {"yosys": "yosys", "yosys-smtbmc": "yosys", "z3": "z3"}


class BadList(Exception):
    """proofs.toml does not fit the RTL or itself: exit status 2."""


class Failed(Exception):
    """What a proof ended with that is neither a proof nor a counterexample."""


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def load():
    with open(os.path.join(FORMAL, "proofs.toml"), "rb") as file:
        proofs = tomllib.load(file)["proof"]
    for proof in proofs:
        if proof["kind"] not in KINDS:
            raise BadList(f"{proof['name']}: kind is one of {', '.join(KINDS)}")
        if "inside" not in proof and "harness" not in proof:
            raise BadList(f"{proof['name']}: has neither harness nor inside")
    if len({proof["name"] for proof in proofs}) != len(proofs):
        raise BadList("two proofs have one name")
    return proofs


def run(command, work, limit):
    """(status, output) of a tool; after `limit` seconds of wall clock it and its children are ended."""
    with subprocess.Popen(command, cwd=work, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True) as process:
        try:
            output, _ = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise Failed(f"no answer in {limit} s") from None
        return process.returncode, output


def files(proof):
    return ["quadrille_pkg.sv", *proof.get("rtl", [])]


def sources(proof, fault, work):
    """Copies of the files of a proof, fault and checker in them; the checker goes before the end of its module, as a bind would (Yosys has none)."""
    names = files(proof)
    for name in names:
        text = read(os.path.join(ROOT, "rtl", name))
        base = os.path.basename(name)
        for edit in fault.edits if fault else ():
            if edit.file == "rtl/" + name:
                text = edit.put(text)
        if "inside" in proof and base == proof["top"] + ".sv":
            end = text.rindex("endmodule")
            text = text[:end] + read(os.path.join(FORMAL, proof["inside"])) + text[end:]
        with open(os.path.join(work, base), "w", encoding="utf-8") as file:
            file.write(text)
    if "harness" in proof:
        for name in (proof["harness"], *proof.get("includes", [])):
            shutil.copy(os.path.join(FORMAL, name), work)
            if name.endswith(".sv"):
                names.append(name)
    for name in os.listdir(os.path.join(ROOT, "rtl", "include")):
        shutil.copy(os.path.join(ROOT, "rtl", "include", name), work)
    return [os.path.basename(name) for name in names]


def elaborate(proof, fault, work, limit):
    defines = "".join(f" -DQUADRILLE_{key.upper()}={value}" for key, value in proof.get("settings", {}).items())
    parameters = "".join(f" -chparam {key} {value}" for key, value in proof.get("parameters", {}).items())
    own = "" if proof.get("own_assertions", True) else " -DSYNTHESIS"
    cut = "".join(f"proc *{name}\\* *{name}\ncutpoint *{name} *{name}\\*\n" for name in proof.get("cut", []))
    script = (f"read_verilog -sv -formal{own}{defines} {' '.join(sources(proof, fault, work))}\n"
              f"hierarchy -check -top {proof['top']}{parameters}\n"
              f"{cut}prep -flatten\nmemory_map\nopt -fast\nasync2sync\ndffunmap\nopt_clean\nwrite_smt2 -wires machine.smt2\n")
    with open(os.path.join(work, "elaborate.ys"), "w", encoding="utf-8") as file:
        file.write(script)
    status, output = run(["yosys", "-q", "-s", "elaborate.ys"], work, limit)
    if status != 0:
        raise Failed("yosys: " + output.strip()[-500:])


WHOLE = "--noincr"  # each question whole, so that z3 simplifies it first: minutes become seconds, but not of many clocks in which nothing is found


def solve(options, work, limit):
    """Whether no assertion fails; and the first that does."""
    status, output = run(["yosys-smtbmc", "-s", "z3", "--unroll", "--noprogress", *options, "machine.smt2"], work, limit)
    if "Status: PASSED" in output and status == 0:
        return True, ""
    # Yosys gives a label, or a location at whose end the assertion stands.
    if "Status: FAILED" in output and (found := re.search(r"Assert failed in .*: (\S+)", output)):
        place = re.match(r"(\S+?):[\d.]+-(\d+)\.", found.group(1))
        return False, read(os.path.join(work, place.group(1))).splitlines()[int(place.group(2)) - 1].strip() if place else found.group(1)
    raise Failed("yosys-smtbmc: " + output.strip()[-500:])


def bounded(proof, depth):
    """Options of a run from the start: every step, or of a pipeline the last alone."""
    return [WHOLE, "-t", f"{depth}:{depth + 1}" if proof["kind"] == "pipeline" else str(depth)]


def prove(proof, limit):
    with tempfile.TemporaryDirectory(prefix="prove-") as work:
        elaborate(proof, None, work, limit)
        proved, where = solve(bounded(proof, proof["depth"]), work, limit)
        if proved and proof["kind"] == "induction":
            proved, where = solve([WHOLE, "-i", "-t", str(proof["depth"])], work, limit)
            where = where and f"induction step: {where}"
        return proved, where


def prove_bounded(proof, limit):
    with tempfile.TemporaryDirectory(prefix="prove-") as work:
        elaborate(proof, None, work, limit)
        # A few clocks of wide words are faster as whole questions, many of narrow ones as a series.
        return solve([*([WHOLE] if proof["bounded"] <= 10 else []), "-t", str(proof["bounded"])], work, limit)


def find_fault(proof, fault, limit):
    with tempfile.TemporaryDirectory(prefix="prove-") as work:
        elaborate(proof, fault, work, limit)
        proved, where = solve(bounded(proof, proof.get("fault_depth", proof["depth"])), work, limit)
        return not proved, where or "no counterexample"


def depths(proof):
    """Kind and depth; of a pipeline, how many clocks from any contents."""
    text = f"{proof['kind']}, depth {proof['depth']}"
    return text + (f"; bounded, depth {proof['bounded']}, in the tier all" if "bounded" in proof else "")


def widths(proof):
    """Configuration keys and parameters that are not the default's."""
    return ", ".join(f"{key} = {value}" for part in ("settings", "parameters") for key, value in proof.get(part, {}).items()) or "the default configuration's"


def attempt(task):
    """(as expected, what was found, seconds) of a proof or a fault."""
    start = time.monotonic()
    try:
        good, where = task()
    except Failed as failure:
        good, where = False, str(failure)
    return good, where, time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="only list the proofs")
    parser.add_argument("--only", action="append", metavar="NAME", help="only this proof; repeatable")
    parser.add_argument("--tier", choices=("default", "all"), default="all", help="default tier: proofs that take seconds (default: all)")
    parser.add_argument("--faults", action="store_true", help="check recorded faults instead of proofs")
    parser.add_argument("--count", type=int, default=0, metavar="N", help="number of faults, drawn by $QUADRILLE_TEST_SEED (default: all)")
    parser.add_argument("--record", action="append", default=[], metavar="FAULT", help="record the proofs that find this fault; repeatable")
    parser.add_argument("--limit", type=int, default=900, metavar="SECONDS", help="wall clock per run of a tool (default: 900)")
    parser.add_argument("-j", "--jobs", type=int, default=1, metavar="N", help="parallel proofs (default: 1)")
    args = parser.parse_args()
    proofs = [proof for proof in load() if args.tier == "all" or proof.get("tier") == "default"]
    if args.only:
        if unknown := set(args.only) - {proof["name"] for proof in proofs}:
            raise BadList(f"no proof {', '.join(sorted(unknown))}; --list")
        proofs = [proof for proof in proofs if proof["name"] in args.only]
    if args.list:
        for proof in proofs:
            print(f"{proof['name']} ({depths(proof)}): {proof['what']}\n    widths: {widths(proof)}\n    assumed: {proof['assumptions']}")
        return 0
    for tool, package in TOOLS.items():
        if not shutil.which(tool):
            print(f"prove.py: no {tool}; install with: apt-get install {package}", file=sys.stderr)
            return 3
    os.nice(10)

    if args.faults:
        tasks, known = [], registry.registry()
        if unknown := set(args.record) - set(known):
            raise BadList(f"no fault {', '.join(sorted(unknown))}")
        for fault in known.values():
            for proof in proofs:
                if fault.name in args.record and any(edit.file == "rtl/" + name for edit in fault.edits for name in files(proof)) \
                        or not args.record and proof["name"] in fault.caught.get("proofs", ()):
                    tasks.append((proof, fault.name, lambda p=proof, f=fault: find_fault(p, f, args.limit)))
        for proof in () if args.record else proofs:
            if not any(proof is task[0] for task in tasks):
                raise BadList(f"{proof['name']}: no fault is recorded that it finds")
        tasks = registry.pick(tasks, args.count, key=lambda task: f"{task[0]['name']} {task[1]}")
        print("| proof | fault | counterexample to | s | |\n|---|---|---|---|---|")
    else:
        tasks = []
        for proof in proofs:
            tasks.append((proof, proof["assumptions"], lambda p=proof: prove(p, args.limit)))
            if "bounded" in proof and args.tier == "all":
                tasks.append((proof | {"kind": "bounded", "depth": proof["bounded"]}, proof["assumptions"], lambda p=proof: prove_bounded(p, args.limit)))
        print("| proof | kind | depth | assumed | s | |\n|---|---|---|---|---|---|")
    bad, found = 0, {name: [] for name in args.record}
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for (proof, text, _), (good, where, seconds) in zip(tasks, pool.map(lambda task: attempt(task[2]), tasks)):
            bad += not good
            if good and args.record:
                found[text].append(proof["name"])
            text = text.replace("|", "\\|").replace("\n", " ")
            if args.faults:
                print(f"| {proof['name']} | `{text}` | {where} | {seconds:.1f} | {'found' if good else 'NOT FOUND'} |", flush=True)
            else:
                print(f"| {proof['name']} | {proof['kind']} | {proof['depth']} | {text} | {seconds:.1f} | {'proved' if good else 'NOT PROVED: ' + where} |", flush=True)
    if args.record:
        record = registry.read_record()
        tried = {proof["name"] for proof, _, _ in tasks}
        for name, by in found.items():
            entry = record.setdefault(name, {})
            entry["proofs"] = sorted({*by, *(p for p in entry.get("proofs", ()) if p not in tried)})
        registry.write_record(record)
        bad = sum(not by for by in found.values())
    print(f"{len(tasks) - bad} of {len(tasks)} {'faults found' if args.faults else 'proved'}")
    return 1 if bad else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (BadList, ValueError) as error:
        print(f"prove.py: {error}", file=sys.stderr)
        sys.exit(2)
