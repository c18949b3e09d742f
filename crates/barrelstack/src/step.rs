//! The time step when none is given: from the stiffest contact.

use barrelstack_dynamics::body::Motion;
use barrelstack_dynamics::{Basis, Model, Nodes, Planar};

use crate::assemble::Assembly;

/// Share of the critical time step that is taken: accuracy asks for more than stability.
///
/// With it the six- and eight-barrel cases of the paper close their energy books to better than
/// 2e-5, and halving the step moves no fall by more than 2 ms.
const SHARE: f64 = 0.1;

/// Penetration (m) at which laws that stiffen with penetration are measured.
const REFERENCE: f64 = 0.01;

/// The time step (s): a share of the critical one, rounded down to a number that is easily said
/// at full scale; `time_scale` is that of similitude.
///
/// The critical time step of an explicit method is 2/ω, with ω² = Σk/m for the stiffest body: the
/// springs of all nodes of one of its boundaries that face one target, over its mass.
pub fn default_step(assembly: &Assembly, time_scale: f64) -> f64 {
    let full_scale = critical_time_step(&assembly.model) / time_scale;
    let step = if full_scale.is_finite() { round_down(SHARE * full_scale) } else { 1e-3 };
    step * time_scale
}

/// The critical time step (s) of a model; infinite when nothing can touch.
pub fn critical_time_step(model: &Model<Planar>) -> f64 {
    let mut most = 0.0_f64;
    for pair in model.pairs() {
        let interface = &model.interfaces()[pair.interface];
        let stiffness = interface.normal.tangent_stiffness(REFERENCE);
        let weight = |tributary: f64| match interface.basis {
            Basis::Node => 1.0,
            Basis::Length => tributary,
        };
        let nodes = match &model.bodies()[pair.contactor].nodes[pair.nodes] {
            // Of the nodes around a body, a quarter at most faces one target.
            Nodes::Fixed(nodes) => {
                let total: f64 = nodes.iter().map(|n| weight(n.tributary_length)).sum();
                let two: f64 = nodes.iter().take(2).map(|n| weight(n.tributary_length)).sum();
                (0.25 * total).max(two)
            }
            Nodes::Rolling { tributary_length, .. } => weight(*tributary_length),
        };
        for body in [pair.contactor, pair.target] {
            let body = &model.bodies()[body];
            if body.motion == Motion::Free {
                // A body is held from below and above.
                most = most.max(2.0 * nodes * stiffness / body.mass);
            }
        }
    }
    2.0 / most.sqrt()
}

/// The largest of these digits times a power of ten that is not above a number.
fn round_down(value: f64) -> f64 {
    const DIGITS: [f64; 8] = [1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let power = 10.0_f64.powf(value.log10().floor());
    let digit = value / power;
    power * DIGITS.into_iter().rev().find(|kept| digit >= *kept).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::round_down;

    #[test]
    fn steps_are_round_numbers() {
        for (value, kept) in [(1.4e-4, 1e-4), (2.7e-4, 2.5e-4), (9.9e-4, 8e-4), (1.0e-3, 1e-3)] {
            assert!((round_down(value) / kept - 1.0).abs() < 1e-12, "{value}");
        }
    }
}
