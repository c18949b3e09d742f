# %% [markdown]
# # An animation of a run
#
# The stack of the paper falls under its sine; the package draws the film, here from 1 to 3.5 s.
# %%
from pathlib import Path

from barrelstack import Scenario
from IPython.display import Image

run = Scenario.load("candia-8-barrels").run(variants=0)
run.render("film", "animation", between=(1.0, 3.5), rate=12, size=360)
film = next(Path("film").rglob("*.gif"))
assert run.outcome.kind == "collapse" and 1.0 < run.outcome.time < 3.5
assert film.read_bytes().startswith(b"GIF89a") and film.stat().st_size < 1_000_000
Image(film.read_bytes(), format="gif")
# %% [markdown]
# The first body leaves its seat within the film. The film shows one run of the nominal stack; a verdict needs the variants, some of which fall at another time or to the other side.
