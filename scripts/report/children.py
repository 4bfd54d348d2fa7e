"""The programs that units of long work run: their reports, how they ended, and the signals that end them."""
import json
import os
import shlex
import signal
import subprocess
import sys
import threading
import time

from report.files import InputError, MissingTool

OUTSIDE = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL)  # no fault of the program ends it with these
KILL_AFTER = 5  # seconds


class Stopped(Exception):
    """This script was told to end."""


class Lost(Exception):
    """Of a unit that something else ended."""


class NoReport(Exception):
    """The program ended without a report where one was due; the message says how, the same on every machine."""


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


def checked(command, silent=(2, 126, 127)):
    """A run that ended by itself. NoReport where it died, which is a fault; Lost where something else killed it; InputError where the command
    is wrong: a status of `silent`, and nothing was said."""
    result = run(command)
    status, ended = result.returncode, f"{shlex.join(command)}: ended with status {result.returncode}"
    if -status in OUTSIDE:
        raise Lost(f"killed by {signal.Signals(-status).name}, which is no fault of its own: {shlex.join(command)}")
    if status == 3:
        raise MissingTool(result.stderr + ended)
    if status in silent and not result.stdout:
        raise InputError(result.stderr + ended)
    if status < 0:
        sys.stderr.write(result.stderr[-4000:])
        raise NoReport(f"killed by {signal.Signals(-status).name}")
    return result


def json_report(command):
    """What a run says as JSON, and its exit status."""
    result = checked(command)
    try:
        return json.loads(result.stdout), result
    except ValueError:
        sys.stderr.write(result.stderr[-4000:])
        raise NoReport(f"status {result.returncode} without a report") from None


def processors():
    """That this process may use: of a Slurm task as many as it was given, on whatever node."""
    usable, given = len(os.sched_getaffinity(0)), os.environ.get("SLURM_CPUS_PER_TASK", "")
    return min(usable, int(given)) if given.isdigit() and int(given) > 0 else usable
