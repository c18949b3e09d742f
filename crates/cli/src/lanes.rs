//! Option `--lanes`: the vector unit that runs the cases of an ensemble.

use barrelstack::ensemble::Width;

/// Option of all commands that run ensembles.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct LanesArgs {
    /// Vector unit in which cases run side by side: avx512, avx2, or scalar for one case at a time;
    /// by default, the widest vector unit of this machine. Results do not depend on the vector
    /// unit.
    #[arg(long, value_name = "UNIT", value_parser = here)]
    pub(crate) lanes: Option<Width>,
}

/// Parses the name of a vector unit; an error if this machine does not have the unit.
fn here(name: &str) -> Result<Width, String> {
    Width::named(name).filter(|width| width.is_here()).ok_or_else(|| {
        let here = Width::ALL.into_iter().filter(|width| width.is_here()).map(Width::name);
        let what = if Width::named(name).is_some() { "this machine has no" } else { "there is no" };
        format!("{what} {name}; this machine has {}", here.collect::<Vec<_>>().join(", "))
    })
}
