# %% [markdown]
# # Histories as a netCDF file
#
# The histories of a run as a dataset of xarray, with time as the dimension and units as attributes, written to netCDF and read back.
# %%
import numpy as np
import xarray as xr
from barrelstack import Record, Scenario

record = Record.bundled().process("compact").scale(pgv="40 cm/s")
run = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "40 s"}).run(record, variants=0)
units = run.histories.units
columns = {name: ("time", run.histories[name], {"units": units[name]}) for name in units if name != "time"}
data = xr.Dataset(columns, {"time": ("time", run.histories.time, {"units": "s"})}, {"title": run.headline})
data.to_netcdf("run.nc")
again = xr.load_dataset("run.nc", decode_times=False)
assert again.identical(data) and again["B3.1_displacement_x"].attrs["units"] == "m"
# %%
peak = float(np.abs(again["B3.1_displacement_x"]).max())
print(f"{dict(again.sizes)}, {len(again.data_vars)} histories; the top barrel moves by up to {1000 * peak:.0f} mm")
# %% [markdown]
# The file holds the same bits as the run: any program that reads netCDF can continue from here. `decode_times=False` keeps the time in seconds, which xarray would else read as a duration.
# Displacements are relative to the ground and to the position at rest.
