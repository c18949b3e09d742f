//! Mass, center of mass and moments of inertia of solids, of compound bodies, and of filled barrels.

use super::{Ball, Barrel, Capsule};
use crate::math;
use crate::space::{Quaternion, Rotation3, Vec3};

/// Mass distribution of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bulk {
    /// Mass (kg).
    pub mass: f64,
    /// Center of mass (m).
    pub center: Vec3,
    /// Second moments `∫ r r dm` (kg·m²) about the center of mass, row by row.
    pub second: [Vec3; 3],
}

impl Bulk {
    /// Creates a distribution that is symmetric about the coordinate planes, from its mass (kg) and the second moments
    /// `∫ x² dm`, `∫ y² dm` and `∫ z² dm` (kg·m²).
    fn symmetric(mass: f64, second: Vec3) -> Self {
        let Vec3 { x, y, z } = second;
        let rows = [Vec3::new(x, 0.0, 0.0), Vec3::new(0.0, y, 0.0), Vec3::new(0.0, 0.0, z)];
        Self { mass, center: Vec3::default(), second: rows }
    }

    /// Returns the mass distribution of a homogeneous ball of the given mass (kg).
    pub fn of_ball(ball: &Ball, mass: f64) -> Self {
        let second = 0.2 * mass * ball.radius * ball.radius;
        Self::symmetric(mass, Vec3::new(second, second, second))
    }

    /// Returns the mass distribution of a homogeneous capsule of the given mass (kg).
    pub fn of_capsule(capsule: &Capsule, mass: f64) -> Self {
        let Capsule { half_length: l, radius: r } = *capsule;
        // Shares of the tube and of the ball formed by both ends.
        let ball = 2.0 * r / (2.0 * r + 3.0 * l);
        let tube = 1.0 - ball;
        let along = tube * l * l / 3.0 + ball * (l * l + 0.75 * l * r + 0.2 * r * r);
        let across = r * r * (0.25 * tube + 0.2 * ball);
        Self::symmetric(mass, Vec3::new(along, across, across) * mass)
    }

    /// Returns the mass distribution of a thin-walled tube with open ends, such as a tube of a rack, given its mass
    /// (kg). The outer surface of the tube is given as a capsule.
    pub fn of_hollow(capsule: &Capsule, mass: f64) -> Self {
        let Capsule { half_length: l, radius: r } = *capsule;
        let across = 0.5 * r * r;
        Self::symmetric(mass, Vec3::new(l * l / 3.0, across, across) * mass)
    }

    /// Returns the mass distribution of a homogeneous block with sharp edges, given half its side lengths (m) and its
    /// mass (kg).
    pub fn of_block(half: Vec3, mass: f64) -> Self {
        Self::symmetric(mass, half.times(half) * (mass / 3.0))
    }

    /// Returns the mass distribution of a homogeneous barrel of the given mass (kg).
    pub fn of_barrel(barrel: &Barrel, mass: f64) -> Self {
        let outside = revolved(barrel);
        outside.of_density(mass / outside.volume)
    }

    /// Returns the mass distribution after the body is rotated about the origin and then displaced by `offset` (m).
    #[must_use]
    pub fn placed(&self, offset: Vec3, rotation: Rotation3) -> Self {
        // R S Rᵀ: first its rows, then its columns.
        let half = Rotation3 { rows: self.second.map(|row| rotation.apply(row)) }.back();
        let second = half.rows.map(|row| rotation.apply(row));
        Self { mass: self.mass, center: offset + rotation.apply(self.center), second }
    }

    /// Returns the sum of several distributions.
    pub fn sum(parts: impl IntoIterator<Item = Self> + Clone) -> Self {
        let (mut mass, mut first) = (0.0, Vec3::default());
        for part in parts.clone() {
            mass += part.mass;
            first += part.center * part.mass;
        }
        let center = first * (1.0 / mass);
        let mut second = [Vec3::default(); 3];
        for part in parts {
            let arm = part.center - center;
            for ((row, own), far) in second.iter_mut().zip(part.second).zip([arm.x, arm.y, arm.z]) {
                *row += own + arm * (far * part.mass);
            }
        }
        Self { mass, center, second }
    }

    /// Returns the principal moments of inertia (kg·m²) about the center of mass, and the rotation from the frame of
    /// the principal axes to the frame of the distribution.
    ///
    /// Uses Jacobi's method: each step eliminates the largest off-diagonal element by a rotation about one axis, until
    /// the matrix is diagonal. For distributions that are symmetric about their coordinate planes, the principal axes
    /// are the axes of the frame.
    pub fn principal(&self) -> (Vec3, Quaternion) {
        let mut turned = Quaternion::identity();
        let mut second = self.second;
        for _ in 0..50 {
            let [x, y, z] = second;
            let aside = [(x.y, x.x, y.y), (y.z, y.y, z.z), (z.x, z.z, x.x)];
            let (plane, (off, first, last)) = match aside {
                [a, b, c] if a.0.abs() >= b.0.abs() && a.0.abs() >= c.0.abs() => (2, a),
                [_, b, c] if b.0.abs() >= c.0.abs() => (0, b),
                [_, _, c] => (1, c),
            };
            if off.abs() <= 1e-17 * (x.x + y.y + z.z) {
                break;
            }
            let angle = 0.5 * math::atan2(2.0 * off, first - last);
            let mut axis = Vec3::default();
            match plane {
                0 => axis.x = angle,
                1 => axis.y = angle,
                _ => axis.z = angle,
            }
            turned = turned.after(Quaternion::turn(axis)).normalized();
            let upright = Self { mass: self.mass, center: Vec3::default(), second: self.second };
            second = upright.placed(Vec3::default(), turned.matrix().back()).second;
        }
        let [x, y, z] = [second[0].x, second[1].y, second[2].z];
        (Vec3::new(y + z, z + x, x + y), turned)
    }
}

impl Barrel {
    /// Returns the volume (m³).
    pub fn volume(&self) -> f64 {
        revolved(self).volume
    }
}

/// Contents of a barrel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fill {
    /// Empty.
    Empty,
    /// Full, with contents that rotate with the wood.
    Frozen,
    /// Full of wine, which does not rotate with the wood about the barrel's axis, and only partly about other axes.
    Fluid,
}

/// A wooden barrel with a cavity for wine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cask {
    /// Outer surface.
    pub barrel: Barrel,
    /// Thickness (m) of staves and heads.
    pub wall: f64,
    /// Distance (m) of the heads from the ends of the staves.
    pub chime: f64,
    /// Mass (kg) of the wood.
    pub wood: f64,
    /// Density (kg/m³) of the contents.
    pub density: f64,
}

/// Integrals over a symmetric body of revolution about `x`.
#[derive(Clone, Copy, Debug)]
struct Revolved {
    /// Volume (m³).
    volume: f64,
    /// `∫ x² dV` (m⁵).
    along: f64,
    /// `∫ y² dV` (m⁵).
    across: f64,
}

impl Revolved {
    fn less(self, other: Self) -> Self {
        Self {
            volume: self.volume - other.volume,
            along: self.along - other.along,
            across: self.across - other.across,
        }
    }

    fn of_density(self, density: f64) -> Bulk {
        let second = Vec3::new(self.along, self.across, self.across) * density;
        Bulk::symmetric(self.volume * density, second)
    }
}

impl Cask {
    /// Returns the integrals over the cavity for wine, and the integrals over the whole space inside the staves.
    fn rooms(&self) -> [Revolved; 2] {
        let end = self.barrel.half_length + self.barrel.rounding;
        [end - self.chime - self.wall, end].map(|end| within(&self.barrel, self.wall, end))
    }

    /// Returns the volume (m³) of the cavity for wine.
    pub fn capacity(&self) -> f64 {
        self.rooms()[0].volume
    }

    /// Returns the integrals over the wood: the staves, and the two heads between the staves.
    fn staves_and_heads(&self) -> Revolved {
        let [room, open] = self.rooms();
        let outer_face = self.barrel.half_length + self.barrel.rounding - self.chime;
        let heads = within(&self.barrel, self.wall, outer_face).less(room);
        let staves = revolved(&self.barrel).less(open);
        Revolved {
            volume: staves.volume + heads.volume,
            along: staves.along + heads.along,
            across: staves.across + heads.across,
        }
    }

    /// Returns the mass distribution of wood and contents.
    ///
    /// Wine does not rotate about the axis of a rolling barrel, since its boundary layer is thin. About a transverse
    /// axis, wine rotates like the liquid in a spheroid with the same second moments. The effective moment of inertia
    /// of this liquid is `(∫ x² − ∫ y²)² / (∫ x² + ∫ y²)` (Lamb, Hydrodynamics, on the ellipsoidal shell filled with
    /// liquid). Mass and center of mass include the wine; the returned second moments are those of an equivalent rigid
    /// body.
    pub fn bulk(&self, fill: Fill) -> Bulk {
        let wood = self.staves_and_heads();
        let wood = wood.of_density(self.wood / wood.volume);
        let room = self.rooms()[0];
        match fill {
            Fill::Empty => wood,
            Fill::Frozen => Bulk::sum([wood, room.of_density(self.density)]),
            Fill::Fluid => {
                // The wine adds no moment of inertia about the axis; about transverse axes it adds that of the
                // spheroid.
                let (across, along) = (room.across, room.along);
                let turning = (along - across) * (along - across) / (along + across);
                let wine = Revolved { volume: room.volume, along: turning, across: 0.0 };
                Bulk::sum([wood, wine.of_density(self.density)])
            }
        }
    }

    /// Returns the mass distribution of wine at rest in a lying barrel whose cavity is filled to the fraction `filled`
    /// (0 to 1); `z` is up.
    ///
    /// The wine lies at the bottom with a level surface, and stays there while the barrel rolls.
    pub fn wine_at_rest(&self, filled: f64) -> Bulk {
        let room = self.rooms()[0];
        let end = self.barrel.half_length + self.barrel.rounding - self.chime - self.wall;
        let radius = |x: f64| stave(&self.barrel, x) - self.wall;
        // Bisection for the level (m above the axis) at that volume.
        let (mut low, mut high) = (-radius(0.0), radius(0.0));
        for _ in 0..60 {
            let level = 0.5 * (low + high);
            if below(level, end, &radius)[0] < filled * room.volume {
                low = level;
            } else {
                high = level;
            }
        }
        let [volume, first, along, across, upward] = below(0.5 * (low + high), end, &radius);
        let height = first / volume;
        let upward = upward - volume * height * height;
        let second = Vec3::new(along, across, upward) * self.density;
        let at_bottom = Bulk::symmetric(volume * self.density, second);
        Bulk { center: Vec3::new(0.0, 0.0, height), ..at_bottom }
    }
}

/// Returns the radius (m) of the stave, before its edges are rounded, at a position (m) along the barrel.
fn stave(barrel: &Barrel, x: f64) -> f64 {
    let arc = barrel.stave_radius + barrel.rounding;
    (arc * arc - x * x).sqrt() - barrel.stave_offset
}

/// Integrates over an interval by Gauss quadrature, with five points in each of 16 parts.
fn integral<const N: usize>((from, to): (f64, f64), of: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    const PARTS: u32 = 16;
    let inner = (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let outer = (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let root = 13.0 * 70.0_f64.sqrt();
    let weights = [(322.0 - root) / 900.0, (322.0 + root) / 900.0, 128.0 / 225.0];
    let points = [
        (-outer, weights[0]),
        (-inner, weights[1]),
        (0.0, weights[2]),
        (inner, weights[1]),
        (outer, weights[0]),
    ];
    let half = 0.5 * (to - from) / f64::from(PARTS);
    let mut sum = [0.0; N];
    for part in 0..PARTS {
        let middle = from + (2.0 * f64::from(part) + 1.0) * half;
        for (point, weight) in points {
            for (sum, value) in sum.iter_mut().zip(of(middle + point * half)) {
                *sum += weight * half * value;
            }
        }
    }
    sum
}

/// Returns the contributions of a thin disc to the integrals of [`Revolved`], per unit length of the axis. `x` is the
/// position (m) of the disc along the axis, and `r` its radius (m).
fn disc(x: f64, r: f64) -> [f64; 3] {
    let area = std::f64::consts::PI * r * r;
    [area, area * x * x, 0.25 * area * r * r]
}

/// Returns the integrals over a symmetric body, given the integrals over one half of it in the order of the fields of
/// [`Revolved`].
fn doubled([volume, along, across]: [f64; 3]) -> Revolved {
    Revolved { volume: 2.0 * volume, along: 2.0 * along, across: 2.0 * across }
}

/// Returns the integrals over a whole barrel.
fn revolved(barrel: &Barrel) -> Revolved {
    let grown = barrel.rounding;
    let arc = barrel.stave_radius + grown;
    let turn = math::asin(barrel.half_length / barrel.stave_radius);
    // Integrated over the angle of the normal, so that the integrand is smooth up to the end of the chime.
    let of_stave = integral((0.0, turn), |angle| {
        let (sin, cos) = (math::sin(angle), math::cos(angle));
        disc(arc * sin, arc * cos - barrel.stave_offset).map(|part| part * arc * cos)
    });
    let of_chime = integral((turn, std::f64::consts::FRAC_PI_2), |angle| {
        let (sin, cos) = (math::sin(angle), math::cos(angle));
        let (x, r) = (barrel.half_length + grown * sin, barrel.head_radius + grown * cos);
        disc(x, r).map(|part| part * grown * cos)
    });
    doubled(std::array::from_fn(|i| of_stave[i] + of_chime[i]))
}

/// Returns the integrals over the space inside the staves of a barrel, up to the distance `end` (m) on both sides of
/// the middle. `wall` is the thickness (m) of the staves.
fn within(barrel: &Barrel, wall: f64, end: f64) -> Revolved {
    doubled(integral((0.0, end), |x| disc(x, stave(barrel, x) - wall)))
}

/// Returns integrals over the part of a body of revolution about `x` that is below a level (m above the axis), with `z`
/// up: `∫ dV` (m³), `∫ z dV` (m⁴), `∫ x² dV`, `∫ y² dV` and `∫ z² dV` (m⁵).
///
/// `radius` returns the radius (m) at a position along the axis, up to `end` (m) on both sides of the middle.
fn below(level: f64, end: f64, radius: &impl Fn(f64) -> f64) -> [f64; 5] {
    let section = |x: f64| {
        let r = radius(x);
        let h = level.clamp(-r, r);
        let half_chord = (r * r - h * h).sqrt();
        let angle = math::acos(-h / r);
        let area = r * r * angle + h * half_chord;
        let cube = half_chord * half_chord * half_chord;
        let upward = 0.25 * r * r * area - 0.5 * h * cube;
        let across = 0.25 * r * r * area + h * cube / 6.0;
        [area, -2.0 / 3.0 * cube, area * x * x, across, upward]
    };
    // The formula of the section changes where the level meets the staves, so the integral is split there.
    let (mut inside, mut outside) = (0.0, end);
    for _ in 0..60 {
        let x = 0.5 * (inside + outside);
        if radius(x) > level.abs() { inside = x } else { outside = x }
    }
    let (first, last) = (integral((0.0, inside), section), integral((inside, end), section));
    std::array::from_fn(|i| 2.0 * (first[i] + last[i]))
}
