"""Runs built from the real measured files, where a test needs the physics and not the reader."""

from pathlib import Path

import numpy as np
import pandas as pd
import scipy.io
import xarray as xr

from tribolab.quantities import stamp


def _run(time: np.ndarray, source: Path, **signals: np.ndarray) -> xr.Dataset:
    data = xr.Dataset(
        {name: ("time", values) for name, values in signals.items()},
        coords={"time": time - time[0]},
    )
    return stamp(data, source=source.name, time_origin_s=float(time[0]))


def actuator(folder: Path, name: str) -> xr.Dataset:
    path = folder / "actuator_friction_CC0" / f"{name}.csv"
    table = pd.read_csv(path, sep="\t", header=None, usecols=[0, 4, 6]).to_numpy()
    return _run(table[:, 0] / 1e3, path, position=table[:, 1] / 1e3, friction_force=table[:, 2])


def rock(folder: Path) -> xr.Dataset:
    path = folder / "rock_velstep_MIT" / "velstep4_BRAVA_expb819_basalt.txt"
    table = pd.read_csv(path, sep="\t").to_numpy()
    return _run(
        table[:, 0],
        path,
        position=table[:, 1] * 1e-6,
        friction_coefficient=table[:, 2],
        normal_stress=table[:, 3] * 1e6,
    )


def paper(folder: Path, stiffness: int, speed: int) -> xr.Dataset:
    path = folder / "stickslip_paper_CeCILL-B" / f"k{stiffness}Nm_v{speed}.mat"
    content = scipy.io.loadmat(path)
    run = _run(content["t"].ravel(), path, friction_coefficient=content["Fnorm"].ravel())
    return run.assign_attrs(set_speed_m_s=speed * 1e-6, stiffness_N_m=float(stiffness))
