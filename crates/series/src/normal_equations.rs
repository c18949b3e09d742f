//! Regularized least squares by normal equations.

/// Ridge parameter `λ` as a fraction of the largest diagonal entry. The ridge regularizes
/// correlated unknowns.
const RIDGE: f64 = 1e-4;

/// Normal equations `(CᵀC + λI) b = Cᵀ r`, solved by Cholesky factorization.
pub struct System {
    size: usize,
    normal: Vec<f64>,
    right: Vec<f64>,
}

impl System {
    /// Creates a system with `size` unknowns and without equations.
    pub fn new(size: usize) -> Self {
        Self { size, normal: vec![0.0; size * size], right: vec![0.0; size] }
    }

    /// Adds one equation: a row of `C` and the corresponding value of `r`.
    pub fn add(&mut self, row: &[f64], value: f64) {
        for j in 0..self.size {
            self.right[j] += row[j] * value;
            let sums = &mut self.normal[j * self.size..][..=j];
            for k in 0..sums.len() {
                sums[k] += row[j] * row[k];
            }
        }
    }

    /// Solves the system and returns the unknowns.
    pub fn solve(mut self) -> Vec<f64> {
        let n = self.size;
        let m = &mut self.normal;
        let largest = (0..n).map(|k| m[k * n + k]).fold(0.0, f64::max);
        for k in 0..n {
            m[k * n + k] += RIDGE * largest;
        }
        for j in 0..n {
            for k in 0..=j {
                let sum = (0..k).fold(m[j * n + k], |sum, i| sum - m[j * n + i] * m[k * n + i]);
                m[j * n + k] = if j == k { sum.max(1e-300).sqrt() } else { sum / m[k * n + k] };
            }
        }
        let mut b = self.right;
        for j in 0..n {
            let sum = (0..j).fold(b[j], |sum, k| sum - m[j * n + k] * b[k]);
            b[j] = sum / m[j * n + j];
        }
        for j in (0..n).rev() {
            let sum = (j + 1..n).fold(b[j], |sum, k| sum - m[k * n + j] * b[k]);
            b[j] = sum / m[j * n + j];
        }
        b
    }
}
