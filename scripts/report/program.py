"""The program and the data that belong to these scripts, in a source tree or installed (PREFIX/share/quadrille); how a script begins and ends."""
import argparse
import os
import signal
import sys

from report.files import Failed

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
INSTALLED = not os.path.exists(os.path.join(ROOT, "CMakeLists.txt"))
PROGRAM = os.path.normpath(os.path.join(ROOT, "../../bin/quadrille" if INSTALLED else "build/release/quadrille"))


def options(doc, **more):
    return argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter, **more)


def _page(argument):
    if "#" in argument:
        raise argparse.ArgumentTypeError(f"'{argument}' has a #, behind which a link puts what it opens")
    return argument


def page_option(parser, default):
    parser.add_argument("--page", metavar="URL", type=_page, default=default,
                        help="address of the page of model/page (cmake --build build/release --target page), from the written file or absolute; links open it "
                             "with what they stand for (default: %(default)s)")


def usage(doc, right):
    """For a script without options: --help prints `doc` and ends it, as arguments do that are not `right`, with status 2."""
    asked = sys.argv[1:] in (["--help"], ["-h"])
    if asked or not right:
        print(doc.strip(), file=sys.stdout if asked else sys.stderr)
        sys.exit(0 if asked else 2)


def end(main):
    """Ends the script with the status that `main` returns, or with that of its exception and the message. SIGTERM and Ctrl-C end it as an exception
    does, so that temporary folders go."""
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    try:
        sys.exit(main())
    except Failed as error:
        print(f"{os.path.basename(sys.argv[0])}: {error}", file=sys.stderr)
        sys.exit(error.status)
    except KeyboardInterrupt:
        print(f"{os.path.basename(sys.argv[0])}: interrupted", file=sys.stderr)
        sys.exit(128 + signal.SIGINT)
