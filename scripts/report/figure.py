"""A figure of matplotlib and its bytes, for scripts that draw with it alone. Ends a script with status 3 where Debian's matplotlib is missing."""
import io
import os
import sys

try:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
except ImportError as missing:
    print(f"{os.path.basename(sys.argv[0])}: {missing}; install with: apt-get install python3-matplotlib "
          f"(this is {sys.executable}, Debian's is /usr/bin/python3)", file=sys.stderr)
    sys.exit(3)


def new_figure(width, height):
    """Inches, of 100 pixels."""
    figure = Figure(figsize=(width, height), dpi=100)
    FigureCanvasAgg(figure)
    return figure


def png(figure):
    """The same figure, the same bytes."""
    image = io.BytesIO()
    figure.savefig(image, format="png", metadata={"Software": None})
    return image.getvalue()
