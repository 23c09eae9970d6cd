"""A measured spectrum from a CSV file, and the peaks that stand out of the noise."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite, nan
from pathlib import Path

import numpy as np

from solidgear.core import SolidgearError, show

FEWEST_LINES, MOST_LINES = 8, 2_000_000
MOST_BYTES = 200_000_000
#: dB above the running median over so many lines, which noise alone passes in one line of 10^7 (its
#: amplitude is Rayleigh's: the median is 1.18 sigma, and exp(-(5 x 1.18)^2 / 2) is 3e-8)
ABOVE, NEIGHBOURS = 20 * np.log10(5.0), 51
#: dB by which a peak rises from the dips beside it: half of its amplitude
RISES = 20 * np.log10(2.0)
#: share by which two gaps between lines may differ and be even
EVEN = 1e-2
_UNIT = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_NO_FREQUENCY = ("rpm", "1/min", "r/min", "cpm", "order", "khz", "rad", "time")


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A measured spectrum."""

    name: str  #: of the file
    what: str  #: name of the amplitude in the first line of the file; empty without one
    unit: str  #: of the amplitude, from the same line
    frequency_hz: np.ndarray  #: (n,) ascending
    amplitude: np.ndarray  #: (n,)

    @property
    def in_decibels(self) -> bool:
        """True where amplitudes are levels."""
        return self.unit.casefold().startswith("db")

    @property
    def level(self) -> np.ndarray:
        """Amplitude (n,) in dB; zeros lie 200 dB below the largest."""
        if self.in_decibels:
            return self.amplitude
        return 20 * np.log10(np.maximum(self.amplitude, 1e-10 * self.amplitude.max()))

    @property
    def resolution_hz(self) -> np.ndarray:
        """Distance (n,) of every line to the farther neighbour, Hz."""
        gaps = np.diff(self.frequency_hz)
        return np.maximum(np.append(gaps[0], gaps), np.append(gaps, gaps[-1]))

    def peaks(self) -> list[tuple[float, float, float]]:
        """Return frequency, amplitude and resolution of every peak that stands out, by frequency; of even
        lines the frequency is that of the parabola through three levels.

        Examples
        --------
        >>> hz = np.arange(100.0)
        >>> tone = 1e-3 + np.exp(-((hz - 40.3) / 1.5) ** 2)
        >>> [(round(f, 1), res) for f, _, res in Spectrum("", "", "", hz, tone).peaks()]
        [(40.3, 1.0)]
        """
        # each of these costs a tenth of a second to import
        from scipy.ndimage import median_filter
        from scipy.signal import find_peaks

        level, resolution = self.level, self.resolution_hz
        floor = median_filter(level, min(NEIGHBOURS, len(level)), mode="nearest")
        places, _ = find_peaks(level, height=floor + ABOVE, prominence=RISES)
        return [(self._top(k), float(self.amplitude[k]), float(resolution[k])) for k in places]

    def _top(self, k: int) -> float:
        hz, (a, b, c) = self.frequency_hz[k - 1 : k + 2], self.level[k - 1 : k + 2]
        step = hz[2] - hz[1]
        bend = a - 2 * b + c
        if bend >= 0 or abs(hz[1] - hz[0] - step) > EVEN * step:
            return float(hz[1])
        return float(hz[1] + step * (a - c) / (2 * bend))


def read_spectrum(path: str | os.PathLike) -> Spectrum:
    """Read a spectrum: two columns, frequency in Hz and amplitude, under a first line with their
    names and units such as ``frequency [Hz], acceleration [m/s^2]``, or without one.

    Columns are parted by a comma, a semicolon, a tab or blanks; further columns are not read, nor
    lines that begin with ``#``.  A first column that is not in Hz, frequencies that do not ascend,
    and negative amplitudes that are no levels in dB are refused.
    """
    file = os.fspath(path)
    try:
        if os.path.getsize(path) > MOST_BYTES:
            raise SolidgearError(f"{file}: larger than {MOST_BYTES:g} bytes; is it a spectrum?")
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not a text in UTF-8"
        raise SolidgearError(f"{file}: the spectrum cannot be read: {reason}") from None
    rows = list(_rows(text))
    quantity = unit = ""
    if rows and not _is_number(rows[0][1][0]):
        quantity, unit = _header(rows.pop(0)[1], file)
    if len(rows) < FEWEST_LINES:
        raise SolidgearError(
            f"{file}: {len(rows)} lines of numbers are too few for a spectrum; give "
            f"{FEWEST_LINES} or more, frequency in Hz and amplitude"
        )
    values = np.array([_pair(cells, line, file) for line, cells in rows[:MOST_LINES]])
    spectrum = Spectrum(Path(file).name, quantity, unit, values[:, 0], values[:, 1])
    _refuse(spectrum, [line for line, _ in rows], file)
    return spectrum


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield number and cells of every line with content."""
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        mark = next((mark for mark in ";\t," if mark in line), None)
        cells = [cell.strip().strip('"') for cell in line.split(mark)]
        if mark in (";", "\t") and "." not in line:  # decimals with a comma
            cells = [
                cell.replace(",", ".") if _is_number(cell.replace(",", ".")) else cell
                for cell in cells
            ]
        yield number, cells


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _header(cells: list[str], file: str) -> tuple[str, str]:
    """Return name and unit of the amplitude; the frequency must be in Hz."""
    unit = _UNIT.search(cells[0])
    frequency_unit = (unit.group(1) if unit else cells[0]).casefold()
    if (unit and frequency_unit != "hz") or any(word in frequency_unit for word in _NO_FREQUENCY):
        raise SolidgearError(
            f"{file}: the first column is {show(cells[0], 40)}; it must be a frequency in Hz, such "
            'as "frequency [Hz]"'
        )
    if len(cells) < 2:
        return "", ""
    unit = _UNIT.search(cells[1])
    return _UNIT.sub("", cells[1]).strip(), unit.group(1) if unit else ""


def _pair(cells: list[str], line: int, file: str) -> tuple[float, float]:
    words = (cells + ["", ""])[:2]
    pair = tuple(float(word) if _is_number(word) else nan for word in words)
    if not all(map(isfinite, pair)):
        raise SolidgearError(
            f"{file}: line {line} is {show(', '.join(cells), 60)}; it must hold two finite numbers, "
            "a frequency in Hz and an amplitude"
        )
    return pair[0], pair[1]


def _refuse(spectrum: Spectrum, lines: list[int], file: str) -> None:
    hz, size = spectrum.frequency_hz, spectrum.amplitude
    back = np.flatnonzero(np.diff(hz) <= 0)
    if back.size:
        k = int(back[0]) + 1
        raise SolidgearError(
            f"{file}: line {lines[k]} goes from {hz[k - 1]:g} to {hz[k]:g} Hz; frequencies must "
            "ascend"
        )
    if hz[0] < 0:
        raise SolidgearError(f"{file}: begins at {hz[0]:g} Hz; a frequency must not be negative")
    if not spectrum.in_decibels and size.min() < 0:
        k = int(size.argmin())
        raise SolidgearError(
            f"{file}: line {lines[k]} has an amplitude of {size[k]:g}; amplitudes must not be "
            'negative, unless the first line says that they are levels, such as "level [dB]"'
        )
    if not spectrum.in_decibels and not size.max() > 0:
        raise SolidgearError(f"{file}: all amplitudes are zero; nothing was measured")
