"""Draws the chart of README.md, time at equal error, from the table of docs/peers.md.

    python3 scripts/chart.py            writes docs/images/time_at_equal_error.svg
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CHART = ROOT / "docs" / "images" / "time_at_equal_error.svg"
# Row of the table, what the chart calls it, what stands beside the bar, its colour.
BARS = [
    ("unipbd, pressure grid, h = 2 dx, target 10 %", "unipbd, coarse", "", "#2f7fd6"),
    ("unipbd, pressure grid, h = 3 dx, target 1 % (default)", "unipbd, default", "", "#7db4ec"),
    ("SPlisHSPlasH 2.19 DFSPH 0.1 %", "SPlisHSPlasH, 0.1 %", "", "#9aa7b4"),
    ("SPlisHSPlasH 2.19 DFSPH 1 %", "SPlisHSPlasH, 1 %", "", "#9aa7b4"),
    ("salva2d 0.11 DFSPH 0.3 %", "salva2d, 0.3 %", "", "#9aa7b4"),
]
WIDTH, LEFT, TOP, ROW, BAR = 860, 200, 54, 44, 24
FULL = 340  # pixels of the longest bar


def rows(text: str) -> dict[str, tuple[float, str]]:
    """Time [s] and mean of |C| by solver, of the dam break of 5,000."""
    part = text.split("## Dam break of 5000 particles", 1)[1].split("\n## ", 1)[0]
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in part.splitlines() if line.startswith("| ")]
    return {row[0]: (float(row[1]), row[5]) for row in cells if re.fullmatch(r"[\d.]+", row[1])}


def draw(text: str) -> str:
    measured = rows(text)
    longest = max(measured[row][0] for row, *_ in BARS)
    height = TOP + ROW * len(BARS) + 16
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        'font-family="sans-serif" font-size="15" fill="#1b2733">',
        f'<rect width="{WIDTH}" height="{height}" rx="8" fill="#f7f9fb"/>',
        '<text x="20" y="30" font-weight="bold">Processor time per simulated second, and mean density error'
        "</text>",
    ]
    for number, (row, name, note, colour) in enumerate(BARS):
        time, error = measured[row]
        y, length = TOP + number * ROW, max(2.0, FULL * time / longest)
        outline = ' stroke="#9aa7b4" stroke-dasharray="4 3"' if colour == "none" else ""
        lines += [
            f'<text x="{LEFT - 12}" y="{y + 17}" text-anchor="end">{name}</text>',
            f'<rect x="{LEFT}" y="{y}" width="{length:.1f}" height="{BAR}" fill="{colour}"{outline}/>',
            f'<text x="{LEFT + length + 10:.1f}" y="{y + 17}">{time:.2g} s'
            f'<tspan fill="#5b6b7c" font-size="13">  {note}{error}</tspan></text>',
        ]
    return "\n".join([*lines, "</svg>"]) + "\n"


if __name__ == "__main__":
    CHART.write_text(draw((ROOT / "docs" / "peers.md").read_text(encoding="utf-8")), encoding="utf-8")
