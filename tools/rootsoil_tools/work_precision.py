# SPDX-License-Identifier: MIT
def draw(rows, problems, folder): pass
def page(rows, problems): return ""
