# %% [markdown]
# # An animation of a run
#
# The stack of the paper falls under its sine. The view of the animation, here from 1 to 3.5 s, can be turned with the mouse; the notebook keeps it, and needs no network.
# %%
from pathlib import Path

from barrelstack import Scenario

run = Scenario.load("candia-8-barrels").run(variants=0)
film = run.animate(between=(1.0, 3.5))
film.save("film.html")
assert run.outcome.kind == "collapse" and 1.0 < run.outcome.time < 3.5
assert Path("film.html").read_text(encoding="utf-8") == film.html() and len(film._repr_html_()) < 1_000_000
film
# %% [markdown]
# The first body leaves its seat within the animation. It shows one run of the nominal stack; a verdict needs the variants, some of which fall at another time or to the other side.
#
# A cell of a long run is kept below 1 MB by fewer frames per second (`rate`) or by a part of the run (`between`).
