#!/usr/bin/env python3
import sys

import run_long

sys.exit(run_long.main("campaign", sys.argv[1:]))
