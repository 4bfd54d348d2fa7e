"""Runs of `quadrille cosim`: inputs to draw, configurations at random, and sums of what the runs compared and found."""
import glob
import json
import os
import shlex
import signal
import subprocess
import sys
import threading
import time

from report.files import InputError
from report.program import ROOT
from report.units import Lost

FAMILIES = (
    "general perspective any_w near_edge on_edge near_vertex on_vertex sliver collapsed_edge straight_corner reflex bowtie "
    "tiny huge eye_crossing eye_in_hull w_zero shared_edge shared_vertex coplanar long_span coincident"
).split()
# Corner groups with the draw state that each needs (`quadrille scenes --corner`).
CORNERS = {
    "face_plane": [], "flat": ["--no-depth"], "den_w_zero": ["--set", "significand_bits=12"], "negative_r2": ["--set", "quadratic_frac_bits=3"],
    "z_limits": ["--znear", "0.25", "--zfar", "0.75"], "minus_zero": [], "two_corner": [], "two_edge": ["--no-perspective"],
    "tall": ["--size", "192x704"], "burst": [], "extreme": [], "far_corner": ["--size", "4096x4096"],
    "constant_depth": ["--znear", "0.25", "--zfar", "0.75"], "one_corner": [], "far_base": [], "ties": [], "saturation": [], "box": [],
    "plane": ["--set", "plane_quads=1", "--skip", "all"],
    "coarse_depth": ["--set", "hierarchical_z_bits=12", "--set", "hierarchical_z_tiles_log2=8", "--skip", "all"],
    "far_depth": ["--znear", "0.25", "--zfar", "0.75"],
}
# Tiles are hidden where a draw asks for it: every second one with a depth test. (Plane quads are looked for and never found: weights as
# attributes are not plane. tb/lockstep/cosim_test.cpp draws some.)
SKIPPING = ["--set", "hierarchical_z_bits=12", "--set", "hierarchical_z_tiles_log2=8", "--set", "plane_quads=1", "--set", "performance_counters=1"]


OUTSIDE = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL)  # no fault of the program ends it with these
KILL_AFTER = 5  # seconds


class Stopped(Exception):
    """This script was told to end."""


class NoReport(Exception):
    """The program ended without a report where one was due; the message says how, the same on every machine."""


class MissingTool(InputError):
    """The program says that one is missing: exit status 3."""


class Children:
    """The processes that run, which a signal to this script ends at once: those that are over by then keep their results."""

    def __init__(self):
        self.running, self.stopped = set(), False

    def stop_at_signals(self):
        """On a thread of its own, which no lock that the main thread waits for holds up."""
        seen, caught = os.pipe()
        os.set_blocking(caught, False)
        signal.set_wakeup_fd(caught)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(number) is not signal.SIG_IGN:  # nohup
                signal.signal(number, lambda *_: None)
        threading.Thread(target=self.stop, args=(seen,), daemon=True).start()

    def stop(self, seen):
        os.read(seen, 1)
        self.stopped = True
        self.end(signal.SIGTERM)  # the program then ends the tools that it runs and removes its temporary files
        time.sleep(KILL_AFTER)
        self.end(signal.SIGKILL)

    def end(self, number):
        for process in list(self.running):
            process.send_signal(number)

    def run(self, command):
        if self.stopped:
            raise Stopped
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0) as process:  # so Ctrl-C comes here alone
            self.running.add(process)
            try:
                if self.stopped:  # before the line above
                    process.send_signal(signal.SIGTERM)
                out, err = process.communicate()
            finally:
                self.running.discard(process)
        if self.stopped and -process.returncode in OUTSIDE:
            raise Stopped
        return subprocess.CompletedProcess(command, process.returncode, out, err)


CHILDREN = Children()
run = CHILDREN.run


def cosim_report(command):
    """What a run says with --json -, and how it ended. NoReport where it died or said nothing whole, which is a fault; Lost where something
    else killed it."""
    result = run(command)
    status = result.returncode
    if -status in OUTSIDE:
        raise Lost(f"killed by {signal.Signals(-status).name}, which is no fault of its own: {shlex.join(command)}")
    if status == 3 or status in (2, 126, 127) and not result.stdout:
        kind = MissingTool if status == 3 else InputError
        raise kind(f"{result.stderr}{shlex.join(command)}: ended with status {status}")
    try:
        if status < 0:
            raise NoReport(f"killed by {signal.Signals(-status).name}")
        return json.loads(result.stdout), result
    except (ValueError, NoReport) as error:
        sys.stderr.write(result.stderr[-4000:])
        raise NoReport(str(error) if status < 0 else f"status {status} without a report") from None


def processors():
    """That this process may use: of a Slurm task as many as it was given, on whatever node."""
    usable, given = len(os.sched_getaffinity(0)), os.environ.get("SLURM_CPUS_PER_TASK", "")
    return min(usable, int(given)) if given.isdigit() and int(given) > 0 else usable


def fail(command, result):
    """Ends the script: a command gave no answer."""
    sys.exit(f"{result.stderr}FAILED: {shlex.join(command)} ended with status {result.returncode}")


MESHES = os.path.join(ROOT, "../shared/meshes")  # which need not be there


def mesh_files(folder):
    """The OBJ files of a folder that was asked for, or of MESHES."""
    files = sorted(glob.glob(os.path.join(folder or MESHES, "*.obj")))
    if folder and not files:
        raise InputError(f"--meshes {folder}: no OBJ file there")
    return files


def set_options(settings):
    """Options of a program for KEY=VALUE…"""
    return [part for setting in settings for part in ("--set", setting)]


def random_configuration(program, rng, dropped_bits):
    """Settings of a configuration at random that can be built."""
    while True:
        settings = {"significand_bits": rng.randint(12, 26), "notch_exact": rng.choice([1, 1, 0]), "align_guard_bits": rng.randint(0, 4),
                    "subpixel_bits": rng.randint(4, 8), "attribute_slots": rng.randint(1, 8), "depth_bits": rng.randint(12, 30),
                    "tile_log2": rng.randint(2, 4), "quad_slots_log2": rng.randint(1, 4), "tile_slots_log2": rng.randint(1, 4),
                    "stamp_fifo_log2": rng.randint(1, 5), "pixels_per_clock": rng.choice([1, 2, 4]), "dot_units": rng.choice([2, 4]), "performance_counters": rng.choice([0, 1]),
                    "hierarchical_z_bits": rng.choice([0, 4, 9, 12]), "hierarchical_z_tiles_log2": rng.randint(6, 9), "plane_quads": rng.choice([0, 1])}
        if dropped_bits:
            settings["quadratic_frac_bits"] = rng.randint(0, 12)
        options = set_options(f"{key}={value}" for key, value in settings.items())
        if run([program, "config", "--quiet", *options]).returncode == 0:
            return options


FAULTS = {"mismatches": "mismatches", "cycle_mismatches": "cycle mismatches", "reference": "coverage differences", "beyond": "values beyond their bound"}


class Totals:
    """What a number of runs compared and found. `passes`: fragments of all passes, each of which draws them with other attributes."""

    def __init__(self):
        self.sum = dict.fromkeys(["runs", "fragments", "passes", "cycles", "bits", *FAULTS], 0)
        self.worst, self.worst_value = 0.0, 0.0

    def add(self, report):
        exact = report["bound"]["applies"]  # with dropped bits of D and r^2 nothing is claimed about the truth
        reference = report["reference_mismatches"] if exact else 0
        beyond = sum(report[key] for key in report if key.startswith("beyond_")) if exact else 0
        for key, value in (("runs", 1), ("fragments", report["fragments"]), ("passes", report["fragments_all_passes"]), ("cycles", report["cycles_all_passes"]),
                           ("bits", report["compared_bits"]), ("mismatches", report["mismatches"]),
                           ("cycle_mismatches", report["cycle_mismatches"]), ("reference", reference), ("beyond", beyond)):
            self.sum[key] += value
        if exact:
            self.worst = max(self.worst, report.get("worst", {}).get("error_over_bound", 0))
            self.worst_value = max(self.worst_value, report["bound"]["attribute_over_bound"], report["bound"]["depth_over_bound"])

    def add_sums(self, sums, worst, worst_value):
        """Those of another."""
        for key, value in sums.items():
            self.sum[key] += value
        self.worst, self.worst_value = max(self.worst, worst), max(self.worst_value, worst_value)

    def print(self, what):
        print(f"{what}: {self.sum['fragments']} fragments, {self.sum['cycles']} cycles, {self.sum['bits']} bits compared")
        print("  " + ", ".join(f"{self.sum[key]} {name}" for key, name in FAULTS.items()) + f"; of its bound the worst weight "
              f"{100 * self.worst:.1f} %, the worst attribute or depth {100 * self.worst_value:.1f} %")

    def failures(self, what):
        return [f"{what}: {self.sum[key]} {name}" for key, name in FAULTS.items() if self.sum[key]]
