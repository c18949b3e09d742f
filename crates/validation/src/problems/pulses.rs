//! Overturning of a block by pulses: the strengths that overturn the block after an impact or without one, and the safe
//! strengths in between.

use crate::drive::Shake;
use crate::problem::{border, halvings, relative, setting};
use crate::{Effort, GRAVITY, Outcome, Problem, theory};

use super::housner::{firm, slender};

const CLOSED: &str = "Makris and Roussos 2000, Zhang and Makris 2001";
const TABLE: &str = "Zhang and Makris 2001, event-driven integration";

/// Frequency parameter p (rad/s) of the block for which the boundaries are published.
const RATE: f64 = 2.14;
/// Slenderness angle α (rad) of the block for which the boundaries are published.
const ALPHA: f64 = 0.25;

/// Shape of a pulse.
#[derive(Clone, Copy)]
enum Form {
    HalfSine,
    OneSine,
    OneCosine,
}

impl Form {
    fn name(self) -> &'static str {
        match self {
            Self::HalfSine => "half-sine",
            Self::OneSine => "one-sine",
            Self::OneCosine => "one-cosine",
        }
    }

    fn pulse(self, acceleration: f64, omega: f64) -> Shake {
        match self {
            Self::HalfSine => Shake::Sine { acceleration, omega, half_waves: 1.0 },
            Self::OneSine => Shake::Sine { acceleration, omega, half_waves: 2.0 },
            Self::OneCosine => Shake::Cosine { acceleration, omega },
        }
    }

    fn closed_form(self, ratio: f64) -> f64 {
        match self {
            Self::HalfSine => theory::half_sine_overturning(ratio),
            Self::OneSine => theory::one_sine_overturning(ratio),
            Self::OneCosine => theory::one_cosine_overturning(ratio),
        }
    }
}

/// Names of the published boundaries, in the order of increasing pulse strength. Beyond the first boundary, the block
/// overturns after an impact. Beyond the second, it is safe. Beyond the third, it overturns without an impact.
const BORDERS: [&str; 3] = ["starts", "safe-again", "without-impact"];

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    list.extend([1.0, 2.0, 3.0, 5.0].map(|ratio| closed(Form::HalfSine, ratio)));
    for form in [Form::OneSine, Form::OneCosine] {
        list.extend([2.0, 3.0, 5.0].map(|ratio| closed(form, ratio)));
    }
    for (ratio, exact) in [(2.0, 1.8015), (3.0, 2.2974), (5.0, 3.2993)] {
        let bracket = (0.97 * exact, 1.03 * exact);
        list.push(tabulated(Form::HalfSine, ratio, BORDERS[2], exact, bracket));
    }
    for (form, ratio, borders) in [
        (Form::OneSine, 2.0, [1.2237, 2.3277, 2.3577]),
        (Form::OneSine, 3.0, [1.4019, 3.5428, 3.6645]),
        (Form::OneSine, 5.0, [2.8832, 6.6836, 7.3362]),
        (Form::OneCosine, 2.0, [1.4080, 4.2496, 5.1893]),
        (Form::OneCosine, 3.0, [1.8578, 6.5103, 10.954]),
    ] {
        let [starts, safe, again]: [f64; 3] = borders;
        // Each bracket reaches halfway to the next boundary, but not farther than 3 % from its own boundary.
        let (low, high) = (0.5 * (starts + safe), 0.5 * (safe + again));
        let brackets = [
            (0.97 * starts, low.min(1.03 * starts)),
            (low.max(0.97 * safe), high.min(1.03 * safe)),
            (high.max(0.97 * again), 1.03 * again),
        ];
        for (at, exact) in borders.into_iter().enumerate() {
            list.push(tabulated(form, ratio, BORDERS[at], exact, brackets[at]));
        }
    }
    list
}

fn closed(form: Form, ratio: f64) -> Problem {
    let exact = form.closed_form(ratio);
    setting(
        format!("pulses/slender-{}-{ratio}", form.name()),
        format!("slender block (α = 0.03), {} of ω/p = {ratio}, no impact", form.name()),
        CLOSED,
    )
    .quantity(
        "pulse amplitude divided by g tan α that overturns the block",
        "",
        relative(exact, 1e-2).fast(2.5e-2),
    )
    .by(move |effort| {
        let block = slender(effort, 1.0);
        let omega = ratio * block.rate();
        let found = border((0.97 * exact, 1.03 * exact), halvings(effort), |strength| {
            let pulse = form.pulse(strength * block.uplift(), omega);
            block.overturns_at_once(&pulse, pulse.end())
        })?;
        let outcome = Outcome::of(found);
        Ok(match form {
            Form::HalfSine => outcome.noted(format!(
                "Housner's √(1 + ρ²) = {:.4} is unconservative",
                (1.0 + ratio * ratio).sqrt()
            )),
            Form::OneSine | Form::OneCosine => outcome,
        })
    })
}

fn tabulated(
    form: Form,
    ratio: f64,
    which: &'static str,
    exact: f64,
    bracket: (f64, f64),
) -> Problem {
    // The block overturns below the boundary `safe-again`, and above the other two boundaries.
    let falls_below = which == BORDERS[1];
    setting(
        format!("pulses/{}-{ratio}-{which}", form.name()),
        format!("block of p = 2.14 /s, α = 0.25, {} of ω/p = {ratio}", form.name()),
        TABLE,
    )
    .quantity(
        "pulse amplitude divided by g tan α at the border in the name",
        "",
        relative(exact, 1e-2).fast(2.5e-2),
    )
    .by(move |effort| {
        let radius = 0.75 * GRAVITY / (RATE * RATE);
        let block = match effort {
            Effort::Fast => firm(effort, radius, ALPHA),
            Effort::Full => firm(effort, radius, ALPHA).refined(1),
        };
        let pulse = |strength: f64| form.pulse(strength * block.uplift(), ratio * RATE);
        let found = border(bracket, halvings(effort), |strength| {
            let pulse = pulse(strength);
            Ok(block.overturns(&pulse, pulse.end())? != falls_below)
        })?;
        if effort == Effort::Fast {
            return Ok(Outcome::of(found));
        }
        let rigid = block.rigid(theory::housner_restitution(ALPHA));
        let own = border(bracket, halvings(effort), |strength| {
            let pulse = pulse(strength);
            let ride = rigid.ride(|t| pulse.acceleration(t), pulse.end(), 5e-4, 15.0);
            Ok(ride.overturned != falls_below)
        })?;
        Ok(Outcome::of(found).noted(format!("rigid-block integrator of this crate: {own:.4}")))
    })
}
