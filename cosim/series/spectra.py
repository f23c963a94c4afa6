"""Spectra of a load, and the period that they show."""

from __future__ import annotations

import numpy as np
from scipy.signal import welch

from coupling.interface import Array

SEGMENTS = 4  #: lengths of a segment in the record; with half overlap seven segments are averaged


def even(t: Array, y: Array, step: float | None = None) -> tuple[Array, Array, float]:
    """Times (m,), loads (m,) and their distance [s]; straight between the samples; else at the median."""
    step = float(np.median(np.diff(t))) if step is None else step
    at = t[0] + step * np.arange(int((t[-1] - t[0]) / step + 1e-9) + 1)
    return at, np.interp(at, t, y), step


def spectrum(t: Array, y: Array, segments: int = SEGMENTS) -> tuple[Array, Array]:
    """Frequencies (m,) [Hz] and one-sided power spectral density (m,) [N^2/Hz] by Welch (1967).

    Hann windows of a ``segments``-th of the record, half overlapping, the linear trend of each taken off. The sum of
    density times distance of the frequencies is the variance; a sine of amplitude a has a^2/2.
    """
    _, load, step = even(t, y)
    length = max(8, len(load) // segments)
    if len(load) < 8:
        return np.empty(0), np.empty(0)
    frequency, density = welch(load, 1.0 / step, "hann", min(length, len(load)), detrend="linear")
    return np.asarray(frequency), np.asarray(density)


def period_by_spectrum(t: Array, y: Array) -> float | None:
    """``1 / f`` of the largest line of the spectrum of the whole record [s]; range (2 steps, a third of the record).

    Hann window, linear trend taken off, zero-padded eightfold, at least three periods in the record. None for a record
    shorter than 16 values, without change, or whose density still rises towards longer periods. The twin of
    `cosim.analysis.features.load_period` for a plain series.
    """
    at, load, step = even(t, y)
    if len(load) < 16 or np.ptp(load) == 0.0:
        return None
    rest = load - np.polynomial.Polynomial.fit(at, load, 1)(at)
    power = np.abs(np.fft.rfft(rest * np.hanning(len(rest)), 8 * len(rest))) ** 2
    frequency = np.fft.rfftfreq(8 * len(rest), step)
    first = int(np.searchsorted(frequency, 3.0 / (at[-1] - at[0])))
    k = first + int(power[first:].argmax())
    return float(1.0 / frequency[k]) if power[k] > max(power[k - 1], 0.0) else None
