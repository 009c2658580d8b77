# SPDX-License-Identifier: MIT
"""What the programs in tools/ share: the closed forms, reading a run's folder, measuring along the root, drawing."""
