//! Masses, centers and moments of inertia against closed forms and against sums over small cells.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::f64::consts::PI;

use barrelstack_dynamics::shape::Surface;
use barrelstack_dynamics::solid::{
    Ball, Barrel, Block, Bulk, Capsule, Cask, Fill, Hull, Part, compound, pairs_between,
};
use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{Quaternion, Rotation3, Solid, Vec3};

fn bordeaux() -> Barrel {
    Barrel::new(0.945, 0.2775, 0.345, 0.01).unwrap()
}

/// Returns a barrel of 225 liters with walls of 25 mm, and with its heads at the position of the original.
fn cask() -> Cask {
    Cask { barrel: bordeaux(), wall: 0.025, chime: 0.063, wood: 48.0, density: 982.0 }
}

/// Returns volume (m³), center (m) and second moments about the origin (m⁵) of the inside, by counting cells.
fn counted(half: Vec3, cells: u32, inside: impl Fn(Vec3) -> bool) -> (f64, Vec3, Vec3) {
    let at = |i: u32, half: f64| half * ((2.0 * f64::from(i) + 1.0) / f64::from(cells) - 1.0);
    let cell = 8.0 * half.x * half.y * half.z / f64::from(cells).powi(3);
    let (mut volume, mut first, mut second) = (0.0, Vec3::default(), Vec3::default());
    for i in 0..cells {
        for j in 0..cells {
            for k in 0..cells {
                let point = Vec3::new(at(i, half.x), at(j, half.y), at(k, half.z));
                if inside(point) {
                    volume += cell;
                    first += point * cell;
                    second += point.times(point) * cell;
                }
            }
        }
    }
    (volume, first * (1.0 / volume), second)
}

fn diagonal(bulk: &Bulk) -> Vec3 {
    Vec3::new(bulk.second[0].x, bulk.second[1].y, bulk.second[2].z)
}

#[test]
fn solids_weigh_and_turn_as_cells_counted_inside_of_them() {
    let tube = Capsule { half_length: 0.5, radius: 0.2 };
    let cases = [
        // The box of the cells ends where the solid ends.
        (
            Solid::Ball(Ball { radius: 0.3 }),
            Bulk::of_ball(&Ball { radius: 0.3 }, 1.0),
            Vec3::new(0.3, 0.3, 0.3),
        ),
        (Solid::Capsule(tube), Bulk::of_capsule(&tube, 1.0), Vec3::new(0.7, 0.2, 0.2)),
        (
            Solid::Barrel(bordeaux()),
            Bulk::of_barrel(&bordeaux(), 1.0),
            Vec3::new(0.4725, 0.345, 0.345),
        ),
        (
            Solid::Block(Block { half: Vec3::new(0.5, 0.1, 0.3), rounding: 0.0 }),
            Bulk::of_block(Vec3::new(0.5, 0.1, 0.3), 1.0),
            Vec3::new(0.5, 0.1, 0.3),
        ),
    ];
    for (solid, bulk, half) in cases {
        let (volume, _, second) = counted(half, 160, |point| solid.gap(point).distance < 0.0);
        let off = (second * (1.0 / volume) - diagonal(&bulk)).length();
        let share = off / diagonal(&bulk).length();
        println!("{share:.1e}");
        assert!(share < 1e-3, "{solid:?}: {share:e}"); // measured 7e-5
    }
}

#[test]
fn a_body_of_revolution_has_its_closed_form() {
    // A barrel with almost no bulge and rounding is a cylinder.
    let (half, radius) = (0.4, 0.3);
    let barrel = Barrel::new(2.0 * half, radius, radius + 1e-9, 1e-9).unwrap();
    let bulk = Bulk::of_barrel(&barrel, 2.0);
    let exact = Vec3::new(half * half / 3.0, 0.25 * radius * radius, 0.25 * radius * radius) * 2.0;
    let off = (diagonal(&bulk) - exact).length();
    assert!(off < 1e-8, "{off:e}"); // measured 1.3e-9, by the bulge
    // The moments equal the integrals over the sections by another quadrature rule.
    let barrel = bordeaux();
    let end = barrel.half_length + barrel.rounding;
    let parts = 400_000;
    let (mut volume, mut along, mut across) = (0.0, 0.0, 0.0);
    for i in 0..parts {
        let x = end * (f64::from(i) + 0.5) / f64::from(parts);
        // The surface is where the distance is zero.
        let (mut low, mut high) = (0.2, 0.4);
        let solid = Solid::Barrel(barrel);
        for _ in 0..40 {
            let r = 0.5 * (low + high);
            if solid.gap(Vec3::new(x, r, 0.0)).distance < 0.0 { low = r } else { high = r }
        }
        let area = PI * low * low;
        volume += area;
        along += area * x * x;
        across += 0.25 * area * low * low;
    }
    let exact = Vec3::new(along / volume, across / volume, across / volume);
    let off = (diagonal(&Bulk::of_barrel(&barrel, 1.0)) - exact).length();
    println!("{off:e}");
    assert!(off < 1e-8, "{off:e}"); // measured 2e-11
}

#[test]
fn parts_add_up_to_the_whole_they_make() {
    // Eight small blocks form a large one, at any position and rotation.
    let half = Vec3::new(0.3, 0.2, 0.5);
    let small = Bulk::of_block(half * 0.5, 1.0);
    let turn = Quaternion::turn(Vec3::new(0.3, -0.7, 0.2)).matrix();
    let offset = Vec3::new(1.0, -2.0, 0.5);
    let corners = (0..8).map(|corner| {
        let sign = |bit: i32| if corner & bit == 0 { -0.5 } else { 0.5 };
        let aside = half.times(Vec3::new(sign(1), sign(2), sign(4)));
        small.placed(offset + turn.apply(aside), turn)
    });
    let sum = Bulk::sum(corners.collect::<Vec<_>>());
    let whole = Bulk::of_block(half, 8.0).placed(offset, turn);
    assert!((sum.mass - 8.0).abs() < 1e-15 && (sum.center - offset).length() < 1e-15);
    for (row, exact) in sum.second.iter().zip(whole.second) {
        assert!((*row - exact).length() < 1e-14);
    }
    // The principal moments are those of the block, in any order.
    let (moments, turned) = sum.principal();
    let mut found = [moments.x, moments.y, moments.z];
    let square = half.times(half);
    let mut exact =
        [square.y + square.z, square.z + square.x, square.x + square.y].map(|sum| 8.0 * sum / 3.0);
    found.sort_by(f64::total_cmp);
    exact.sort_by(f64::total_cmp);
    for (found, exact) in found.into_iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
    }
    let back = turned.matrix().back();
    let upright = sum.placed(Vec3::default(), back).second;
    for (row, own) in upright.iter().zip([Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)]) {
        assert!((*row - own * row.dot(own)).length() < 1e-14);
    }
}

#[test]
fn a_barrel_weighs_and_turns_by_its_fill() {
    let cask = cask();
    assert!((cask.capacity() - 0.225).abs() < 0.002, "{}", cask.capacity());
    let [empty, frozen, fluid] = [Fill::Empty, Fill::Frozen, Fill::Fluid].map(|f| cask.bulk(f));
    assert!((empty.mass - 48.0).abs() < 1e-12);
    assert!((frozen.mass - 48.0 - 982.0 * cask.capacity()).abs() < 1e-10);
    assert_eq!(frozen.mass, fluid.mass);
    let moments = |bulk: &Bulk| bulk.principal().0;
    // Wine does not rotate about the axis, only the wood does.
    assert!((moments(&fluid).x - moments(&empty).x).abs() < 1e-12);
    // 3.9 and 6.0, 14.1 and 22.6, 4.0 and 8.5 kg m² for parabolic staves and thicker heads further out.
    for (bulk, about, across) in [(&empty, 3.9, 6.0), (&frozen, 14.1, 22.6), (&fluid, 4.0, 8.5)] {
        let moments = moments(bulk);
        println!("{:.2} {:.2}", moments.x, moments.y);
        assert!((moments.x / about - 1.0).abs() < 0.09, "{moments:?}");
        assert!((moments.y / across - 1.0).abs() < 0.09, "{moments:?}");
    }
    // Frozen contents are a body of revolution within the wood.
    let room = |point: Vec3| {
        let r = (point.y * point.y + point.z * point.z).sqrt();
        let stave = (1.6875_f64 * 1.6875 - point.x * point.x).sqrt() - 1.3425 - 0.025;
        point.x.abs() < 0.4725 - 0.063 - 0.025 && r < stave
    };
    let (volume, _, second) = counted(Vec3::new(0.3845, 0.32, 0.32), 160, room);
    assert!((volume / cask.capacity() - 1.0).abs() < 1e-3, "{volume}");
    let exact = (second.y + second.z) * 982.0;
    let found = moments(&frozen).x - moments(&empty).x;
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}"); // measured 8e-5
}

#[test]
fn wine_at_rest_in_a_barrel_that_lies_is_at_its_bottom() {
    let cask = cask();
    for filled in [0.1, 0.5, 0.8, 0.97] {
        let wine = cask.wine_at_rest(filled);
        let share = wine.mass / (982.0 * cask.capacity());
        assert!((share - filled).abs() < 1e-9, "{filled}: {share}");
        // Bisection for the level below which there are as many cells.
        let room = |point: Vec3| {
            let r = (point.y * point.y + point.z * point.z).sqrt();
            let stave = (1.6875_f64 * 1.6875 - point.x * point.x).sqrt() - 1.3425 - 0.025;
            point.x.abs() < 0.4725 - 0.063 - 0.025 && r < stave
        };
        let (mut low, mut high) = (-0.33, 0.33);
        let half = Vec3::new(0.3845, 0.32, 0.32);
        let below = |level: f64, cells| counted(half, cells, |p| p.z < level && room(p));
        for _ in 0..14 {
            let level = 0.5 * (low + high);
            if below(level, 160).0 < filled * cask.capacity() { low = level } else { high = level }
        }
        let (volume, center, second) = below(0.5 * (low + high), 200);
        let off = (center - wine.center).length();
        println!("{filled}: center {:.4} off {off:.1e}", wine.center.z);
        assert!(off < 4e-3, "{off}"); // measured 1.7e-3
        let about_center = second.z * (1.0 / volume) - center.z * center.z;
        let found = diagonal(&wine) * (1.0 / wine.mass);
        assert!((found.z / about_center - 1.0).abs() < 0.06, "{} {about_center}", found.z);
        assert!((found.x / (second.x / volume) - 1.0).abs() < 0.02);
        assert!((found.y / (second.y / volume) - 1.0).abs() < 0.02);
    }
    // Completely filled it equals frozen wine.
    let (full, all) = (cask.wine_at_rest(1.0), cask.bulk(Fill::Frozen).mass - 48.0);
    assert!((full.mass / all - 1.0).abs() < 1e-9 && full.center.length() < 1e-9);
}

#[test]
fn a_body_of_parts_stands_where_it_is_described() {
    let tube = Capsule { half_length: 0.7, radius: 0.02 };
    let hull = Hull::Capsule(tube);
    let part = |x: f64, y: f64, mass: f64| Part {
        hull,
        center: Vec3::new(x, y, 0.1),
        rotation: Rotation3::identity(),
        bulk: Bulk::of_capsule(&tube, mass),
    };
    let parts = [part(0.0, -0.3, 5.0), part(0.2, 0.3, 7.0), part(-0.1, 0.1, 3.0)];
    let body = compound("rack", &parts, 1.0);
    assert_eq!(body.mass, 15.0);
    let rotation = body.pose.orientation.matrix();
    for (part, placed) in parts.iter().zip(&body.surfaces) {
        let center = body.pose.position + rotation.apply(placed.offset);
        assert!((center - part.center).length() < 1e-15);
        let axis = rotation.after(placed.rotation).apply(Vec3::new(1.0, 0.0, 0.0));
        assert!((axis - Vec3::new(1.0, 0.0, 0.0)).length() < 1e-14);
    }
    assert_eq!(pairs_between(&[body.clone(), body], 0, 1, 0).len(), 9);
}
