//! Sobol' points in up to 21 dimensions, and in any number of dimensions by padding.
//!
//! The direction numbers are those of Joe and Kuo (2008).

/// Maximum number of dimensions without padding.
pub const DIMENSIONS: usize = 21;

/// Number of cells into which the range of every coordinate is divided.
const CELLS: f64 = 4_294_967_296.0;

/// For each dimension from the second on: degree and coefficients of a primitive polynomial, and the initial
/// direction numbers. These are the first lines of `new-joe-kuo-6.21201`.
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

/// Returns the 32 direction numbers of a dimension; dimensions are counted from 0.
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

/// One dimension of the Sobol' sequence, with a digital shift.
#[derive(Clone, Debug)]
pub struct Axis {
    directions: [u32; 32],
    shift: u32,
}

impl Axis {
    /// Creates the axis of a dimension. Dimensions are counted from 0. `shift` is a digital shift, which preserves the
    /// net property (Owen 1995).
    pub fn new(dimension: usize, shift: u32) -> Self {
        Self { directions: directions(dimension), shift }
    }

    fn digits(&self, point: u32) -> u32 {
        let gray = point ^ (point >> 1);
        (0..32)
            .filter(|bit| gray >> bit & 1 == 1)
            .fold(self.shift, |digits, bit| digits ^ self.directions[bit])
    }

    /// Returns one coordinate of a point; points are counted from 0 in the order of Antonov and Saleev.
    ///
    /// The coordinate is the center of a cell of width 2⁻³².
    pub fn at(&self, point: u32) -> f64 {
        (f64::from(self.digits(point)) + 0.5) / CELLS
    }
}

/// Returns one coordinate of a point; points and dimensions are counted from 0, and the number of dimensions
/// is unlimited.
///
/// Dimensions are divided into groups of [`DIMENSIONS`]. Every group uses the points in a different order,
/// and in every dimension the digits are scrambled (Owen 1995, with the hash of Burley 2020). Each group is
/// therefore a Sobol' net, and groups are independent of each other. If a dimension is divided into 2ᵐ equal
/// parts, each part contains one of the first 2ᵐ points.
pub fn padded(dimension: usize, point: u32, seed: u64) -> f64 {
    let group = (dimension / DIMENSIONS) as u64;
    let order = mixed(seed ^ mixed(2 * group + 1).rotate_left(32));
    let digits = mixed(seed ^ mixed(2 * dimension as u64).rotate_left(32));
    let [order, digits] = [order, digits].map(|bits| u32::try_from(bits >> 32).unwrap_or_default());
    let axis = Axis { directions: directions(dimension % DIMENSIONS), shift: 0 };
    (f64::from(nested(axis.digits(nested(point, order)), digits)) + 0.5) / CELLS
}

/// Returns the hash of a seed (`SplitMix64` by Steele, Lea and Flood 2014).
fn mixed(seed: u64) -> u64 {
    let z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Scrambles the binary digits of a number (Owen 1995). Whether a digit is flipped depends only on the seed and on the
/// more significant digits.
fn nested(digits: u32, seed: u32) -> u32 {
    // The bits are reversed, because in sums and products a bit depends only on itself and on the lower bits.
    let mut x = digits.reverse_bits().wrapping_add(seed);
    for factor in [0x6c50_b47c_u32, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        x ^= x.wrapping_mul(factor);
    }
    x.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::{Axis, DIMENSIONS, padded};

    #[test]
    fn padded_points_fill_every_dimension_and_groups_are_not_alike() {
        let points: Vec<Vec<f64>> = (0..3 * DIMENSIONS)
            .map(|dimension| (0..64).map(|point| padded(dimension, point, 7)).collect())
            .collect();
        for (dimension, one) in points.iter().enumerate() {
            let mut cells: Vec<f64> = one.iter().map(|u| (64.0 * u).floor()).collect();
            cells.sort_by(f64::total_cmp);
            let all: Vec<f64> = (0..64).map(f64::from).collect();
            assert_eq!(cells, all, "dimension {dimension}");
        }
        let product = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| 12.0 * (a - 0.5) * (b - 0.5)).sum::<f64>() / 64.0
        };
        let worst = (0..points.len())
            .flat_map(|a| (0..a).map(move |b| (a, b)))
            .map(|(a, b)| product(&points[a], &points[b]).abs())
            .fold(0.0, f64::max);
        // The largest correlation of any two dimensions; measured 0.58. For as many pairs of independent random
        // dimensions it is about 0.45, and for equal dimensions it is 1.
        assert!(worst < 0.7, "{worst}");
        assert_ne!(padded(3, 5, 7), padded(3, 5, 8));
    }

    /// Returns the index of the cell whose center is the coordinate of a point.
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
                let mut occupied = [false; 256];
                for point in 0..256 {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "0 to 255"
                    )]
                    let cell = (256.0 * axis.at(point)) as usize;
                    assert!(!occupied[cell], "dimension {dimension}: cell {cell} twice");
                    occupied[cell] = true;
                }
            }
        }
    }

    #[test]
    fn the_indices_of_ishigami_are_those_of_its_closed_form() {
        // sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ for x from −π to π: variances in closed form (Ishigami and Homma 1990).
        let (a, b, pi) = (7.0_f64, 0.1_f64, std::f64::consts::PI);
        let f = |x: [f64; 3]| {
            let [s, t] = [x[0], x[1]].map(libm::sin);
            s + a * t * t + b * x[2].powi(4) * s
        };
        let v1 = 0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2);
        let v2 = a * a / 8.0;
        let v13 = b * b * pi.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let v = v1 + v2 + v13;
        let exact = [(v1 / v, (v1 + v13) / v), (v2 / v, v2 / v), (0.0, v13 / v)];
        let axes: Vec<Axis> = (0..6).map(|d| Axis::new(d, 0x9E37_79B9)).collect();
        let blocks: Vec<Vec<f64>> = (0..8192)
            .map(|point| {
                let x = |axis: usize| pi * (2.0 * axes[axis].at(point) - 1.0);
                let (one, two) = ([x(0), x(1), x(2)], [x(3), x(4), x(5)]);
                let exchanged = |k: usize| {
                    let mut mixed = one;
                    mixed[k] = two[k];
                    f(mixed)
                };
                vec![f(one), f(two), exchanged(0), exchanged(1), exchanged(2)]
            })
            .collect();
        let found = crate::sobol_indices(&blocks, 0.95);
        for (index, (first, total)) in found.unwrap().iter().zip(exact) {
            // The error is relative to the exact index; if the exact index is 0, the error is absolute.
            let off = [(index.first, first), (index.total, total)]
                .map(|(found, exact)| (found - exact) / if exact > 0.0 { exact } else { 1.0 });
            // Measured: 7e-4.
            assert!(off.iter().all(|off| off.abs() < 2e-3), "{off:?} of {first} and {total}");
            assert!(index.total_interval.low < total && total < index.total_interval.high);
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
