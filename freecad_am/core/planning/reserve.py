# SPDX-License-Identifier: LGPL-2.1-or-later
"""The margin kept free at every limit (docs/decisions/0009)."""

import math

# rad, and as many mm of axes that slide: the program's last digit, of a degree or a mm, must not take an axis past its limit
RESERVE = math.radians(0.05)
