"""A set of golden vectors as replay.py takes it: manifests, records, what they say about a bench."""
import os
import re
import stat

from report.files import InputError, read_json

FORMAT = 2
# Their inputs enter at different stages; the manifest's latency counts from the last, the wrapper's from the first.
STAGGERED = ("ratios", "weights")
# Kinds of suites that no bench has a device for.
WITHOUT_RTL = ("snapping", "table")
# A field that has the name of a wrapper's port.
RENAMED = {"valid_o": "drawn_o"}


def load_json(path):
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            raise InputError(f"{path}: not a regular file")
        value = read_json(path)
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: {error}") from None
    if not isinstance(value, dict):
        raise InputError(f"{path}: not a JSON object")
    if value.get("format") != FORMAT:
        raise InputError(f"{path}: format {value.get('format')!r}, expected format {FORMAT} (golden/CONVERTING.md)")
    return value


def suite_names(directory):
    suites = load_json(os.path.join(directory, "manifest.json")).get("suites")
    if isinstance(suites, dict):
        return list(suites)
    if isinstance(suites, list):
        return [suite["name"] if isinstance(suite, dict) else suite for suite in suites]
    raise InputError(f"{directory}/manifest.json: no suites")


class Suite:
    """A suite's manifest, its records and the line counts of its files, which are checked here."""

    def __init__(self, directory, name):
        self.name = name
        self.directory = os.path.abspath(os.path.join(directory, name))
        path = os.path.join(self.directory, "manifest.json")
        manifest = load_json(path)
        try:
            if manifest["suite"] != name:
                raise InputError(f"{path}: is of the suite {manifest['suite']}")
            self.kind = manifest["kind"]
            self.latency = int(manifest["latency"]) if self.kind == "stage" and name not in STAGGERED else 0
            self.config = {key: int(value) for key, value in manifest["config"].items()}
            self.records = manifest["records"]
            files = manifest["files"]
            self.bits = {name: int(record["bits"]) for name, record in self.records.items()}
            self.lines = {}
            if self.kind not in WITHOUT_RTL:
                for record in self.records.values():
                    file = record["file"]
                    self.lines[file] = self.count_lines(file, int(record["bits"]))
                    if self.lines[file] != int(files[file]["lines"]):
                        raise InputError(f"{self.path(file)}: {self.lines[file]} lines, the manifest says {files[file]['lines']}")
                if self.kind == "machine":
                    self.check_machine()
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(f"{path}: {type(error).__name__}: {error}") from None

    def check_machine(self):
        """What would keep the bench waiting, or leave it without expectations."""
        if self.lines["beats.hex"] != self.lines["stimulus.hex"]:
            raise InputError(f"{self.path('beats.hex')}: {self.lines['beats.hex']} lines; expected {self.lines['stimulus.hex']}, one per beat")
        with open(self.path("stalls.hex"), encoding="ascii") as file:
            pattern = [int(line, 16) for line in file]
        for bit, what in ((1, "offers"), (0, "takes")):
            if not any(line >> bit & 1 for line in pattern):
                raise InputError(f"{self.path('stalls.hex')}: no clock {what} anything")

    def path(self, file):
        return os.path.join(self.directory, file)

    def count_lines(self, file, bits):
        """Lines of a file in which each line is one record; $readmemh would take much else."""
        digits = (bits + 3) // 4
        good = re.compile(rb"[0-9a-f]{%d}\n" % digits)
        try:
            with open(self.path(file), "rb") as lines:
                count = 0
                for count, line in enumerate(lines, 1):
                    if not good.fullmatch(line):
                        raise InputError(f"{self.path(file)}:{count}: not a record of {digits} hexadecimal digits")
        except OSError as error:
            raise InputError(str(error)) from None
        if count == 0:
            raise InputError(f"{self.path(file)}: no vectors")
        return count

    def vectors(self):
        return self.lines["response.hex"]

    def bench(self):
        """(top module, device, macros with the record widths, macros with capacities)."""
        if self.kind == "machine":
            widths = {"STATE_BITS": self.bits["states"], "VERTEX_BITS": self.position("stimulus", "draw"),
                      "FRAGMENT_BITS": self.position("response", "clock_stalled"),
                      "LANES": self.config.get("pixels_per_clock", 1)}
            sizes = {"DRAWS": self.lines["states.hex"], "BEATS": self.lines["stimulus.hex"],
                     "FRAGMENTS": self.lines["response.hex"], "STALLS": self.lines["stalls.hex"]}
            return "replay_machine", "quadrille", widths, sizes
        if self.lines["stimulus.hex"] != self.lines["response.hex"]:
            raise InputError(f"{self.directory}: stimulus and response have different numbers of lines")
        widths = {"STIMULUS_BITS": self.bits["stimulus"], "RESPONSE_BITS": self.bits["response"]}
        return "replay_stage", f"replay_{self.name}", widths, {"VECTORS": self.lines["response.hex"]}

    def position(self, record, name):
        """Bits below a field of that name."""
        return next(int(field["position"]) for field in self.records[record]["fields"] if field["name"] == name)

    def fields_header(self):
        """A signal for each field or array of a stage's records: NAME_i of the stimulus, NAME_o of the response."""
        lines = [f"// The fields of suite {self.name}, from its manifest."]
        names = {}
        for record, suffix in (("stimulus", "_i"), ("response", "_o")):
            widths = {}
            for field in self.records[record]["fields"]:
                if not re.fullmatch("[a-z][a-z0-9_]*", field["name"]):
                    raise InputError(f"{self.path('manifest.json')}: a field is named {field['name']!r}; expected lower-case letters, digits, _")
                name = RENAMED.get(field["name"] + suffix, field["name"] + suffix)
                widths[name] = widths.get(name, 0) + int(field["width"])
            lines += [f"  logic [{width - 1}:0] {name};" for name, width in widths.items()]
            names[record] = ", ".join(widths)
        return "\n".join(lines + [f"  assign {{{names['stimulus']}}} = stimulus_i;", f"  assign response_o = {{{names['response']}}};", ""])

    def plusargs(self):
        args = [f"+suite={self.name}", f"+stimulus={self.path('stimulus.hex')}", f"+response={self.path('response.hex')}"]
        if self.kind == "machine":
            args += [f"+states={self.path('states.hex')}", f"+taken={self.path('beats.hex')}", f"+stalls={self.path('stalls.hex')}",
                     f"+draws={self.lines['states.hex']}", f"+beats={self.lines['stimulus.hex']}",
                     f"+fragments={self.lines['response.hex']}", f"+pattern={self.lines['stalls.hex']}"]
        else:
            args += [f"+vectors={self.vectors()}", f"+latency={self.latency}"]
        return args

    def fields(self, expected, actual):
        """The response fields in which two hex numbers differ; digits that are not 0-9a-f (unknown bits) differ from all."""
        if not re.fullmatch("[0-9a-f]+", actual):
            return f"unknown bits in {actual}"
        expected, actual = int(expected, 16), int(actual, 16)
        text = []
        for field in self.records["response"]["fields"]:
            width, position = int(field["width"]), int(field["position"])
            values = [(word >> position) & ((1 << width) - 1) for word in (expected, actual)]
            if values[0] != values[1]:
                if field.get("signed"):
                    values = [value - (value >> (width - 1) << width) for value in values]
                index = f"[{field['index']}]" if field.get("index", -1) >= 0 else ""
                text.append(f"{field['name']}{index}: expected {values[0]}, actual {values[1]}")
        return "; ".join(text[:4])
