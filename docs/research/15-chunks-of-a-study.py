# %% [markdown]
# # Chunks of a study, as the jobs of an array
#
# A study is divided into chunks, and any process that sees the folder may run any of them. Here joblib plays the scheduler: its first jobs run half of the chunks, as if the others had been killed; then the missing ones are found and run.
# %%
from barrelstack import Study
from joblib import Parallel, delayed

spread = {"kind": "uniform", "from": 0.2, "to": 0.6}
factor = {"field": "interface.rack-ground.friction.coefficient", "distribution": spread}
base = {"extends": "candia-8-barrels", "stack": {"levels": 2}, "run": {"duration": "4 s"}}
study = Study({"base": base, "factor": [factor], "design": {"kind": "latin-hypercube", "count": 64, "chunk": 8}})
jobs = [delayed(study.run_chunk)("array", chunk.number) for chunk in study.plan()]
Parallel(n_jobs=2)(jobs[::2])
missing = [chunk.number for chunk in study.plan("array")]
Parallel(n_jobs=2)(jobs[number] for number in missing)
assert len(missing) == 4 and study.collect("array").to_csv() == study.run("alone").to_csv()
# %%
round(max(study.collect("array")["base_slip_peak"]), 4)
# %% [markdown]
# The table is that of a single process, byte for byte, whoever ran the chunks and in which order. On Slurm, each job of an array calls `run_chunk` with its number; `barrelstack study emit` writes such a script.
# The number is the largest slip of the base (m); it rests on the assumed range of friction and on one motion.
