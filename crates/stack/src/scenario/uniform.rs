//! Mass properties and sizes of outlines.

use std::f64::consts::PI;

use super::shape::{PartShape, Shape};

/// Mass properties of a uniform plate, or of a uniform arc for a cradle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    /// Center of mass, relative to the reference point (m).
    pub centroid: [f64; 2],
    /// Moment of inertia about the center of mass divided by the mass (m²).
    pub square_radius: f64,
}

impl Shape {
    /// Returns the outlines that form the shape: the parts of a compound, or the shape itself.
    pub fn parts(&self) -> Vec<PartShape> {
        match self {
            Self::Compound { parts } => parts.clone(),
            Self::Rectangle { .. }
            | Self::Circle { .. }
            | Self::Polygon { .. }
            | Self::Cradle { .. }
            | Self::BarrelProfile { .. } => {
                vec![PartShape { shape: self.clone(), offset: [0.0, 0.0], turn: 0.0 }]
            }
        }
    }

    /// Returns the mass properties of a uniform plate with this outline, or of a uniform arc for a cradle.
    ///
    /// In a compound, overlaps of parts count twice, and cradles do not count, because they have no area.
    pub fn uniform(&self) -> Uniform {
        match self {
            Self::Rectangle { width, height, corner_radius } => Uniform {
                centroid: [0.0, 0.0],
                square_radius: rounded_rectangle(*width, *height, *corner_radius),
            },
            Self::Circle { radius } => {
                Uniform { centroid: [0.0, 0.0], square_radius: 0.5 * radius * radius }
            }
            Self::Polygon { vertices } => polygon(vertices),
            Self::Cradle { radius, half_angle } => {
                let depth = radius * libm::sin(*half_angle) / half_angle;
                Uniform { centroid: [0.0, -depth], square_radius: radius * radius - depth * depth }
            }
            Self::BarrelProfile { length, bilge_diameter, head_diameter } => {
                let (area, moment) = barrel_profile(*length, *bilge_diameter, *head_diameter);
                Uniform { centroid: [0.0, 0.0], square_radius: moment / area }
            }
            Self::Compound { parts } => compound(parts),
        }
    }

    /// Returns the enclosed area (m²).
    pub(super) fn area(&self) -> f64 {
        match self {
            Self::Rectangle { width, height, corner_radius } => {
                width * height - (4.0 - PI) * corner_radius * corner_radius
            }
            Self::Circle { radius } => PI * radius * radius,
            Self::Polygon { vertices } => area(vertices),
            Self::Cradle { .. } => 0.0,
            Self::BarrelProfile { length, bilge_diameter, head_diameter } => {
                barrel_profile(*length, *bilge_diameter, *head_diameter).0
            }
            Self::Compound { parts } => parts.iter().map(|part| part.shape.area()).sum(),
        }
    }

    /// Returns the length of the boundary (m); for a barrel profile, the perimeter of the enclosing box.
    pub fn perimeter(&self) -> f64 {
        match self {
            Self::Rectangle { width, height, corner_radius } => {
                2.0 * (width + height) - (8.0 - 2.0 * PI) * corner_radius
            }
            Self::Circle { radius } => 2.0 * PI * radius,
            Self::Polygon { vertices } => sides(vertices)
                .map(|(a, b)| (b[0] - a[0], b[1] - a[1]))
                .map(|(x, z)| (x * x + z * z).sqrt())
                .sum(),
            Self::Cradle { radius, half_angle } => 2.0 * half_angle * radius,
            Self::BarrelProfile { length, bilge_diameter, .. } => 2.0 * (length + bilge_diameter),
            Self::Compound { parts } => parts.iter().map(|part| part.shape.perimeter()).sum(),
        }
    }
}

/// Returns the mass properties of the parts of a compound, all with the same density.
fn compound(parts: &[PartShape]) -> Uniform {
    let placed = || {
        parts.iter().map(|part| {
            let own = part.shape.uniform();
            let (sin, cos) = (libm::sin(part.turn), libm::cos(part.turn));
            let [x, z] = own.centroid;
            let place = [part.offset[0] + cos * x - sin * z, part.offset[1] + sin * x + cos * z];
            (part.shape.area(), place, own.square_radius)
        })
    };
    let area: f64 = placed().map(|(area, ..)| area).sum();
    let mean = |axis: usize| placed().map(|(part, at, _)| part * at[axis]).sum::<f64>() / area;
    let centroid = [mean(0), mean(1)];
    let about = |(part, at, own): (f64, [f64; 2], f64)| {
        let (x, z) = (at[0] - centroid[0], at[1] - centroid[1]);
        part / area * (own + x * x + z * z)
    };
    Uniform { centroid, square_radius: placed().map(about).sum() }
}

/// Returns the polar moment of area of a rectangle with rounded corners, divided by its area (m²).
fn rounded_rectangle(w: f64, h: f64, r: f64) -> f64 {
    let (square, quarter) = (r * r, 0.25 * PI * r * r);
    // Each square corner is replaced by a quarter of a disk; the moments of both are shifted from their own centroids.
    let (u, v) = (0.5 * (w - r), 0.5 * (h - r));
    let corner = square * (square / 6.0 + u * u + v * v);
    let offset = 4.0 * r / (3.0 * PI);
    let own = 0.125 * PI * square * square - quarter * 2.0 * offset * offset;
    let (u, v) = (0.5 * w - r + offset, 0.5 * h - r + offset);
    let disk = own + quarter * (u * u + v * v);
    let area = w * h - 4.0 * (square - quarter);
    (w * h * (w * w + h * h) / 12.0 - 4.0 * (corner - disk)) / area
}

pub(super) fn sides(vertices: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    (0..vertices.len()).map(|i| (vertices[i], vertices[(i + 1) % vertices.len()]))
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns the area of a polygon (m²), positive if its corners are in counterclockwise order.
pub(super) fn area(vertices: &[[f64; 2]]) -> f64 {
    0.5 * sides(vertices).map(|(a, b)| cross(a, b)).sum::<f64>()
}

fn polygon(vertices: &[[f64; 2]]) -> Uniform {
    let area = area(vertices);
    let mut centroid = [0.0, 0.0];
    let mut second = 0.0;
    for (a, b) in sides(vertices) {
        let c = cross(a, b);
        centroid[0] += (a[0] + b[0]) * c / (6.0 * area);
        centroid[1] += (a[1] + b[1]) * c / (6.0 * area);
        let square = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
        second += c * (square(a, a) + square(a, b) + square(b, b)) / 12.0;
    }
    let shift = centroid[0] * centroid[0] + centroid[1] * centroid[1];
    Uniform { centroid, square_radius: second / area - shift }
}

/// Returns the area (m²) and the polar moment of area (m⁴) of the region between `-r(x)` and `r(x)`, where `r` is the
/// parabola of the barrel.
fn barrel_profile(length: f64, bilge: f64, head: f64) -> (f64, f64) {
    // With r = b - s u² and x = L u / 2, integrated over u from 0 to 1 and doubled.
    let (b, s, half) = (0.5 * bilge, 0.5 * (bilge - head), 0.5 * length);
    let mean = b - s / 3.0;
    let mean_with_square = b / 3.0 - s / 5.0;
    let mean_cube = b * b * b - b * b * s + 0.6 * b * s * s - s * s * s / 7.0;
    let area = 4.0 * half * mean;
    let moment = 4.0 * half * (half * half * mean_with_square + mean_cube / 3.0);
    (area, moment)
}
