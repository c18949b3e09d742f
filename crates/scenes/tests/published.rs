//! Tests of the closed-form solutions against published tables.

use barrelstack_scenes::GRAVITY;
use barrelstack_scenes::theory::{
    least_friction_for_rocking, quarter_period, slender_quarter_period, slide_in_half_sine,
    slide_in_rectangular_pulse, steady_slide_amplitude,
};

/// Gravity (m/s²) in the published table of sliding blocks; all displacements are proportional to it.
const TABLE_GRAVITY: f64 = 9.81;

#[test]
fn a_block_let_go_falls_back_in_housners_quarter_period() {
    // Initial rotation divided by α; then p T / 4 of a slender block, and the exact p T / 4 for α = 0.25.
    for (share, slender, exact) in [
        (0.10, 0.46715, 0.46920),
        (0.25, 0.79537, 0.79798),
        (0.50, 1.31696, 1.31938),
        (0.75, 2.06344, 2.06520),
        (0.90, 2.99322, 2.99464),
    ] {
        assert!((quarter_period(0.25, share) - exact).abs() < 1e-5);
        assert!((slender_quarter_period(share) - slender).abs() < 1e-5);
    }
}

#[test]
fn a_block_slides_as_far_as_the_table_says() {
    let scale = GRAVITY / TABLE_GRAVITY;
    let (a, n, duration) = (0.5, 0.2, 0.4);
    assert!((slide_in_rectangular_pulse(a, n, duration) - 0.5886 * scale).abs() < 6e-5);
    assert!((slide_in_half_sine(a, n, duration) - 0.179_80 * scale).abs() < 6e-6);
    let amplitude = steady_slide_amplitude(a, n, std::f64::consts::TAU);
    assert!((amplitude - 0.096_66 * scale).abs() < 6e-6);
}

#[test]
fn the_friction_that_prevents_sliding_while_rocking_is_that_of_the_table() {
    for (s, published) in [
        (0.2, [0.2124, 0.2246, 0.2486, 0.2945, 0.3793]),
        (0.25, [0.2655, 0.2806, 0.3099, 0.3649, 0.4625]),
        (1.0, [1.057, 1.105, 1.182, 1.286, 1.400]),
    ] {
        for (share, published) in [1.25, 1.5, 2.0, 3.0, 5.0].into_iter().zip(published) {
            let exact = least_friction_for_rocking(share * s, s);
            assert!((exact - published).abs() < 6e-4, "s {s}, share {share}: {exact}");
        }
    }
}
