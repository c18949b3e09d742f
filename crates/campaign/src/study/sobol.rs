//! Points of Sobol' in up to 21 dimensions, with the direction numbers of Joe and Kuo (2008).

/// Most dimensions.
pub(super) const DIMENSIONS: usize = 21;

/// Degree and coefficients of a primitive polynomial, and the first direction numbers, of the second dimension on:
/// the first lines of `new-joe-kuo-6.21201`.
const TABLE: [(u32, u32, &[u32]); DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// The 32 direction numbers of a dimension, from 0.
fn directions(dimension: usize) -> [u32; 32] {
    let mut v = [0_u32; 32];
    let Some(row) = dimension.checked_sub(1) else {
        for (bit, v) in v.iter_mut().enumerate() {
            *v = 1 << (31 - bit);
        }
        return v;
    };
    let (degree, coefficients, first) = TABLE[row];
    let s = degree as usize;
    for i in 0..32 {
        if i < s {
            v[i] = first[i] << (31 - i);
            continue;
        }
        v[i] = v[i - s] ^ (v[i - s] >> degree);
        for k in 1..s {
            if coefficients >> (s - 1 - k) & 1 == 1 {
                v[i] ^= v[i - k];
            }
        }
    }
    v
}

/// One dimension of the sequence.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    directions: [u32; 32],
    shift: u32,
}

impl Axis {
    /// A dimension, from 0, with a digital shift that keeps its nets nets (Owen 1995).
    pub(super) fn new(dimension: usize, shift: u32) -> Self {
        Self { directions: directions(dimension), shift }
    }

    /// The coordinate of a point, from 0, in the order of Antonov and Saleev; the middle of its cell of 2⁻³².
    pub(super) fn at(&self, point: u32) -> f64 {
        let gray = point ^ (point >> 1);
        let digits = (0..32)
            .filter(|bit| gray >> bit & 1 == 1)
            .fold(self.shift, |digits, bit| digits ^ self.directions[bit]);
        (f64::from(digits) + 0.5) / 4_294_967_296.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, DIMENSIONS};

    /// Coordinates as cells of 2⁻³², without the half that stands for the middle of the cell.
    fn cell(dimension: usize, point: u32) -> f64 {
        Axis::new(dimension, 0).at(point) - 0.5 / 4_294_967_296.0
    }

    #[test]
    fn the_first_points_are_those_that_are_published() {
        // Joe and Kuo's `sobol.cc` prints these for three dimensions.
        let published = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
            [0.1875, 0.3125, 0.9375],
            [0.6875, 0.8125, 0.4375],
        ];
        for (point, expected) in (0..).zip(published) {
            assert_eq!([0, 1, 2].map(|dimension| cell(dimension, point)), expected);
        }
    }

    #[test]
    fn far_points_of_high_dimensions_are_those_of_scipy() {
        // scipy.stats.qmc.Sobol(21, scramble=False): points 100 and 1000.
        for (point, dimension, expected) in SCIPY {
            assert_eq!(cell(dimension, point), expected, "point {point}, dimension {dimension}");
        }
    }

    #[test]
    fn every_dimension_has_one_point_in_each_cell_of_a_power_of_two() {
        for dimension in 0..DIMENSIONS {
            for shift in [0, 0x9E37_79B9] {
                let axis = Axis::new(dimension, shift);
                let mut seen = [false; 256];
                for point in 0..256 {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "0 to 255"
                    )]
                    let cell = (256.0 * axis.at(point)) as usize;
                    assert!(!seen[cell], "dimension {dimension}: cell {cell} twice");
                    seen[cell] = true;
                }
            }
        }
    }

    const SCIPY: [(u32, usize, f64); 11] = [
        (100, 3, 0.726_562_5),
        (100, 5, 0.742_187_5),
        (100, 9, 0.695_312_5),
        (100, 14, 0.320_312_5),
        (100, 20, 0.757_812_5),
        (1000, 4, 0.280_273_437_5),
        (1000, 7, 0.899_414_062_5),
        (1000, 12, 0.161_132_812_5),
        (1000, 16, 0.719_726_562_5),
        (1000, 18, 0.991_210_937_5),
        (1000, 20, 0.522_460_937_5),
    ];
}
