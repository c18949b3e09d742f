//! Every shape compared with an independently computed boundary: distance, normal, nodes, section, and outline.

use crate::common;

use std::f64::consts::{PI, TAU};

use barrelstack_dynamics::Shape;
use barrelstack_dynamics::Vec2;
use barrelstack_dynamics::lanes::{Lanewise as _, Task, Width};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::shape::{
    BarrelProfile, Circle, Cradle, Gap, HalfPlane, Polygon, PolygonError, Surface,
};
use barrelstack_dynamics::space::{Linear, Planar};
use barrelstack_scenes::tumble::Random;
use proptest::prelude::*;

/// A shape, and its boundary as a fine chain of points that is computed without the code of the shape.
struct Drawn {
    shape: Shape,
    boundary: Vec<Vec2>,
    closed: bool,
    /// Length of the boundary (m).
    length: f64,
    /// Area (m²) of a closed shape.
    area: f64,
    /// Largest distance of the chain from the true boundary (m).
    sagitta: f64,
}

fn polar(radius: f64, angle: f64) -> Vec2 {
    Vec2::new(radius * libm::cos(angle), radius * libm::sin(angle))
}

const FINE: usize = 3000;

fn drawn_circle(radius: f64) -> Drawn {
    Drawn {
        shape: Shape::Circle(Circle { radius }),
        boundary: (0..FINE).map(|i| polar(radius, TAU * i as f64 / FINE as f64)).collect(),
        closed: true,
        length: TAU * radius,
        area: PI * radius * radius,
        sagitta: radius * (TAU / FINE as f64).powi(2) / 8.0,
    }
}

fn drawn_cradle(radius: f64, half: f64) -> Drawn {
    let angle = |i: usize| -PI / 2.0 + half * (2.0 * i as f64 / FINE as f64 - 1.0);
    Drawn {
        shape: Shape::Cradle(Cradle::new(radius, half)),
        boundary: (0..=FINE).map(|i| polar(radius, angle(i))).collect(),
        closed: false,
        length: 2.0 * half * radius,
        area: 0.0,
        sagitta: radius * (2.0 * half / FINE as f64).powi(2) / 8.0,
    }
}

fn drawn_profile(length: f64, head: f64, bilge: f64) -> Drawn {
    let shape = BarrelProfile::new(length, head, bilge).unwrap();
    let top = |i: usize| {
        let x = length * (0.5 - i as f64 / FINE as f64);
        Vec2::new(x, shape.radius_at(x))
    };
    let above: Vec<Vec2> = (0..=FINE).map(top).collect();
    let below = above.iter().rev().map(|p| Vec2::new(p.x, -p.z));
    let half_angle = libm::asin(0.5 * length / shape.stave_radius);
    let stave = 2.0 * half_angle * shape.stave_radius;
    // Under the stave: a rectangle to the chord, and the segment of the circle above it.
    let segment =
        0.5 * shape.stave_radius.powi(2) * (2.0 * half_angle - libm::sin(2.0 * half_angle));
    let boundary = above.iter().copied().chain(below).collect();
    Drawn {
        boundary,
        closed: true,
        length: 2.0 * (stave + head),
        area: length * head + 2.0 * segment,
        sagitta: (length / FINE as f64).powi(2) / shape.stave_radius,
        shape: Shape::BarrelProfile(shape),
    }
}

/// Returns corners on an ellipse, at sorted angles: convex for any angles.
fn drawn_polygon(corners: &[Vec2], corner_radius: f64) -> Drawn {
    let count = corners.len();
    let mut boundary = vec![];
    let (mut length, mut area) = (0.0, 0.0);
    for i in 0..count {
        let (before, here, after) =
            (corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]);
        let (a, b) = (here - before, after - here);
        let turn = libm::atan2(a.x * b.z - a.z * b.x, a.dot(b));
        // The arc touches both sides at this distance from the sharp corner.
        let cut = corner_radius * libm::tan(0.5 * turn);
        let touch = here - a * (cut / a.length());
        let outward = -(a.quarter_turn() * (1.0 / a.length()));
        let center = touch - outward * corner_radius;
        let from = libm::atan2(outward.z, outward.x);
        let steps = if corner_radius > 0.0 { FINE / 10 } else { 0 };
        for k in 0..=steps {
            boundary
                .push(center + polar(corner_radius, from + turn * k as f64 / steps.max(1) as f64));
        }
        length += b.length() - 2.0 * cut + turn * corner_radius;
        area += 0.5 * (here.x * after.z - here.z * after.x);
        // Rounding cuts off the kite at the corner except for its sector.
        area -= corner_radius * cut - 0.5 * turn * corner_radius * corner_radius;
    }
    Drawn {
        shape: Shape::Polygon(Polygon::new(corners, corner_radius).unwrap()),
        boundary,
        closed: true,
        length,
        area,
        sagitta: corner_radius * (PI / (FINE / 10) as f64).powi(2) / 8.0,
    }
}

impl Drawn {
    fn gap(&self, point: Vec2) -> Gap<Planar> {
        Surface::<Planar>::gap(&self.shape, point)
    }

    fn sides(&self) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
        let count = self.boundary.len();
        let sides = if self.closed { count } else { count - 1 };
        (0..sides).map(move |i| (self.boundary[i], self.boundary[(i + 1) % count]))
    }

    /// Returns the unsigned distance to the nearest point of the chain.
    fn brute_distance(&self, point: Vec2) -> f64 {
        let to_side = |(from, to): (Vec2, Vec2)| {
            let (side, offset) = (to - from, point - from);
            let square = side.dot(side);
            let share =
                if square > 0.0 { (offset.dot(side) / square).clamp(0.0, 1.0) } else { 0.0 };
            (offset - side * share).length()
        };
        self.sides().map(to_side).fold(f64::INFINITY, f64::min)
    }

    /// Returns `true` if a point is inside the matter.
    fn is_inside(&self, point: Vec2) -> bool {
        if let Shape::Cradle(cradle) = &self.shape {
            let below = libm::atan2(point.x, -point.z).abs() <= cradle.half_angle();
            return below && point.length() > cradle.radius;
        }
        // Even or odd number of sides to the right of the point.
        let crosses = |(p, q): &(Vec2, Vec2)| {
            (p.z > point.z) != (q.z > point.z)
                && point.x < p.x + (q.x - p.x) * (point.z - p.z) / (q.z - p.z)
        };
        self.sides().filter(crosses).count() % 2 == 1
    }
}

fn convex_corners(count: usize, seed: u64, (a, b): (f64, f64)) -> Vec<Vec2> {
    let mut random = Random(seed);
    let part = TAU / count as f64;
    (0..count)
        .map(|i| {
            let angle = part * (i as f64 + random.within(0.0, 0.7));
            Vec2::new(a * libm::cos(angle) + 0.03, b * libm::sin(angle) - 0.02)
        })
        .collect()
}

fn any_shape() -> impl Strategy<Value = Drawn> {
    prop_oneof![
        (0.05..0.6_f64).prop_map(drawn_circle),
        (0.1..0.6_f64, 0.2..1.5_f64).prop_map(|(radius, half)| drawn_cradle(radius, half)),
        (0.5..1.2_f64, 0.4..0.6_f64, 0.02..0.2_f64)
            .prop_map(|(length, head, bulge)| drawn_profile(length, head, head + bulge)),
        (3..8_usize, any::<u64>(), 0.1..0.5_f64, 0.2..0.5_f64, 0.0..0.02_f64).prop_map(
            |(count, seed, a, b, radius)| {
                let rounded = if seed % 2 == 0 { radius } else { 0.0 };
                drawn_polygon(&convex_corners(count, seed, (a, b)), rounded)
            }
        ),
    ]
}

impl std::fmt::Debug for Drawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.shape.fmt(f)
    }
}

fn points_about(seed: u64, count: usize) -> impl Iterator<Item = Vec2> {
    let mut random = Random(seed);
    (0..count).map(move |_| Vec2::new(random.within(-0.9, 0.9), random.within(-0.9, 0.9)))
}

/// Computes the gaps of points in the first lane of a bundle, while the points in all other lanes lie in the middle of the
/// shape. So no lane takes a shortcut that is correct only for some of them.
struct Beside<'a>(&'a Shape, &'a [Vec2]);

impl Task for Beside<'_> {
    type Output = Vec<Gap<Planar>>;
    fn run<R: Real>(self) -> Self::Output {
        let shape = Shape::<R>::in_all(self.0);
        let gap = |point: &Vec2| {
            let mut points = Vec2::<R>::in_all(&Vec2::default());
            points.put(0, point);
            let gap = shape.gap(points);
            Gap { distance: gap.distance.lane(0), normal: gap.normal.of_lane(0) }
        };
        self.1.iter().map(gap).collect()
    }
}

/// Returns points about a shape, and for each of them a point within a millimeter of the boundary.
fn points_about_and_near(drawn: &Drawn, seed: u64, count: usize) -> Vec<Vec2> {
    let mut random = Random(seed);
    let both = |point: Vec2| {
        let gap = drawn.gap(point);
        [point, point - gap.normal * (gap.distance + random.within(-1e-3, 1e-3))]
    };
    points_about(seed, count).flat_map(both).collect()
}

proptest! {
    #![proptest_config(common::cases(64))]

    #[test]
    fn a_gap_has_the_same_bits_with_and_without_shortcuts(drawn in any_shape(), seed in any::<u64>()) {
        let points = points_about_and_near(&drawn, seed, 40);
        // On a machine without vector units, there is only one lane.
        let beside = Width::widest().run(Beside(&drawn.shape, &points)).unwrap();
        for (point, beside) in points.iter().zip(beside) {
            prop_assert_eq!(drawn.gap(*point), beside, "at {:?}", point);
        }
    }

    #[test]
    fn where_an_arc_is_found_to_be_nearest_it_is(drawn in any_shape(), seed in any::<u64>()) {
        for point in points_about_and_near(&drawn, seed, 40) {
            if Surface::<Planar>::is_by_arc(&drawn.shape, point) {
                let nearest = Surface::<Planar>::nearest(&drawn.shape, point, 0.0);
                prop_assert!(nearest.round, "at {point:?}");
                // Inside the core of a profile, a head can bear a point although a stave is nearest.
                let profile = matches!(drawn.shape, Shape::BarrelProfile(_));
                prop_assert!(!profile || nearest.core > 1e-5, "at {point:?}");
            }
        }
    }

    #[test]
    fn distance_is_that_of_the_nearest_boundary_point(drawn in any_shape(), seed in any::<u64>()) {
        for point in points_about(seed, 12) {
            let gap = drawn.gap(point);
            let brute = drawn.brute_distance(point);
            let tolerance = drawn.sagitta + 1e-9;
            // A cradle has a jump across the rays through its tips: deep inside its matter the tip is nearest.
            let arc_is_nearest = !matches!(drawn.shape, Shape::Cradle(_))
                || (gap.distance.abs() - brute).abs() <= tolerance
                || !drawn.is_inside(point);
            prop_assert!(arc_is_nearest || brute < gap.distance.abs());
            if arc_is_nearest {
                prop_assert!(
                    (gap.distance.abs() - brute).abs() <= tolerance,
                    "at {point:?}: {} for {brute}", gap.distance
                );
            }
            if brute > tolerance {
                prop_assert_eq!(gap.distance < 0.0, drawn.is_inside(point), "at {:?}", point);
            }
        }
    }

    #[test]
    fn the_normal_is_a_unit_vector_and_leads_to_the_surface(
        drawn in any_shape(), seed in any::<u64>()
    ) {
        for point in points_about(seed, 40) {
            let gap = drawn.gap(point);
            prop_assert!((gap.normal.length() - 1.0).abs() < 1e-12);
            let companion = point - gap.normal * gap.distance;
            prop_assert!(
                drawn.gap(companion).distance.abs() < 1e-9,
                "from {point:?}: {:?} is {} away", companion, drawn.gap(companion).distance
            );
        }
    }

    #[test]
    fn the_normal_is_the_gradient_of_the_distance(drawn in any_shape(), seed in any::<u64>()) {
        let (mut checked, count) = (0, 40);
        for point in points_about(seed, count) {
            let slope = |step: f64| {
                let along = |d: Vec2| {
                    (drawn.gap(point + d).distance - drawn.gap(point - d).distance) / (2.0 * step)
                };
                Vec2::new(along(Vec2::new(step, 0.0)), along(Vec2::new(0.0, step)))
            };
            let gradient = slope(1e-6);
            // Where two sides are equally near, the gradient is undefined.
            if (gradient.length() - 1.0).abs() < 1e-6 {
                checked += 1;
                let apart = (gradient - drawn.gap(point).normal).length();
                prop_assert!(apart < 1e-6, "at {point:?}: {apart}");
            }
        }
        prop_assert!(checked > count * 9 / 10, "only {checked} of {count} points were smooth");
    }

    #[test]
    fn whatever_penetrates_may_touch(drawn in any_shape(), seed in any::<u64>()) {
        let mut random = Random(seed);
        for point in points_about(seed, 40) {
            // Also very near the boundary, where rounding could decide.
            let gap = drawn.gap(point);
            let near = point - gap.normal * (gap.distance + random.within(-1e-15, 1e-15));
            for p in [point, near] {
                if drawn.gap(p).distance < 0.0 {
                    prop_assert!(Surface::<Planar>::may_touch(&drawn.shape, p), "at {p:?}");
                }
            }
        }
    }

    #[test]
    fn nodes_lie_on_the_boundary_and_share_its_length(
        drawn in any_shape(), spacing in 0.01..0.2_f64
    ) {
        let nodes = drawn.shape.nodes(spacing);
        for node in &nodes {
            let distance = drawn.gap(node.position).distance;
            prop_assert!(distance.abs() < 1e-12, "{distance:e} at {:?}", node.position);
            prop_assert!(node.tributary_length > 0.0);
        }
        let sum: f64 = nodes.iter().map(|n| n.tributary_length).sum();
        prop_assert!((sum - drawn.length).abs() < 1e-12 * nodes.len() as f64,
            "{sum} of {}", drawn.length);
        for two in nodes.windows(2) {
            let apart = (two[1].position - two[0].position).length();
            prop_assert!(apart <= spacing * (1.0 + 1e-6), "{apart} for {spacing}");
        }
    }

    #[test]
    fn the_outline_lies_on_the_boundary(drawn in any_shape()) {
        let (outline, closed) = drawn.shape.outline();
        prop_assert_eq!(closed, drawn.closed);
        prop_assert!(outline.len() >= 3);
        for point in &outline {
            prop_assert!(drawn.gap(*point).distance.abs() < 1e-12);
        }
        if closed {
            // Counterclockwise, once around: the area inside is that of the shape or slightly less.
            let area: f64 = (0..outline.len())
                .map(|i| {
                    let (p, q) = (outline[i], outline[(i + 1) % outline.len()]);
                    0.5 * (p.x * q.z - p.z * q.x)
                })
                .sum();
            prop_assert!(area <= drawn.area * (1.0 + 1e-12) && area > 0.99 * drawn.area);
        }
    }

    #[test]
    fn no_point_of_the_boundary_is_out_of_reach(drawn in any_shape()) {
        let reach = Surface::<Planar>::reach(&drawn.shape);
        for point in &drawn.boundary {
            prop_assert!(point.length() <= reach * (1.0 + 1e-12));
        }
    }

    #[test]
    fn the_section_has_the_area_of_the_shape(drawn in any_shape()) {
        let section = drawn.shape.section().unwrap();
        let expected = if drawn.closed { drawn.area } else { drawn.length };
        let error = (section.measure / expected - 1.0).abs();
        prop_assert!(error < 3e-4, "{error:e}"); // measured 1.1e-4: rounded corners in 15° chords
    }

    #[test]
    fn centroid_and_gyration_are_those_of_a_fine_grid(drawn in any_shape()) {
        let section = drawn.shape.section().unwrap();
        let (mut count, mut first, mut second) = (0.0, Vec2::default(), 0.0);
        let mut add = |p: Vec2| {
            count += 1.0;
            first += p;
            second += p.dot(p);
        };
        if drawn.closed {
            for i in 0..200 {
                for k in 0..200 {
                    let p = Vec2::new(f64::from(i) - 99.5, f64::from(k) - 99.5) * 0.007;
                    if drawn.gap(p).distance < 0.0 {
                        add(p);
                    }
                }
            }
        } else {
            drawn.boundary.iter().for_each(|p| add(*p));
        }
        let centroid = first * (1.0 / count);
        let gyration = second / count - centroid.dot(centroid);
        let apart = (section.centroid - centroid).length();
        prop_assert!(apart < 1e-3, "centroid off by {apart:e}"); // measured 3.4e-4
        let error = (section.gyration_squared - gyration).abs();
        // measured 8.9e-4: half a grid cell at the flat heads of a profile
        prop_assert!(error < 1.5e-3, "k² off by {error:e}");
    }
}

#[test]
fn sections_of_rectangles_and_circles_are_those_of_the_books() {
    let rectangle = Shape::Polygon(Polygon::rectangle(0.6, 0.2, 0.0).unwrap()).section().unwrap();
    assert!((rectangle.measure - 0.12).abs() < 1e-15);
    assert!(rectangle.centroid.length() < 1e-15);
    assert!((rectangle.gyration_squared - (0.36 + 0.04) / 12.0).abs() < 1e-15);
    let circle = Shape::Circle(Circle { radius: 0.3 }).section().unwrap();
    assert_eq!(circle.gyration_squared, 0.045);
}

#[test]
fn a_floor_has_neither_nodes_nor_section_nor_end() {
    let floor = Shape::HalfPlane(HalfPlane);
    assert!(floor.nodes(0.1).is_empty());
    assert!(floor.section().is_none());
    assert!(Surface::<Planar>::reach(&floor).is_infinite());
    let gap = Surface::<Planar>::gap(&floor, Vec2::new(3.0, -0.25));
    assert_eq!((gap.distance, gap.normal), (-0.25, Vec2::new(0.0, 1.0)));
}

#[test]
fn the_center_of_a_circle_has_a_normal() {
    let gap = Surface::<Planar>::gap(&Shape::Circle(Circle { radius: 0.5 }), Vec2::default());
    assert_eq!((gap.distance, gap.normal), (-0.5, Vec2::new(0.0, 1.0)));
}

#[test]
fn sharp_corners_are_their_own_nodes() {
    let nodes = Polygon::rectangle(0.6, 0.2, 0.0).unwrap().corner_nodes();
    assert_eq!(nodes.len(), 4);
    for node in nodes {
        assert_eq!(node.position.x.abs(), 0.3);
        assert_eq!(node.position.z.abs(), 0.1);
        assert!((node.tributary_length - 0.4).abs() < 1e-15);
    }
}

#[test]
fn sides_are_cut_into_the_same_number_of_parts() {
    for radius in [0.0, 0.02] {
        let polygon = Polygon::rectangle(0.6, 0.2, radius).unwrap();
        let nodes = polygon.nodes_per_side(3);
        let sum: f64 = nodes.iter().map(|n| n.tributary_length).sum();
        let exact = 1.6 - 8.0 * radius + TAU * radius;
        assert!((sum - exact).abs() < 1e-14, "{sum} for {exact}");
        if radius == 0.0 {
            assert_eq!(nodes.len(), 12);
            assert!((nodes[1].tributary_length - 0.2).abs() < 1e-15);
        }
    }
}

proptest! {
    #![proptest_config(common::cases(64))]

    #[test]
    fn a_mirrored_and_a_scaled_polygon_are_as_far_as_they_should_be(
        seed in any::<u64>(), count in 3..8_usize, radius in 0.0..0.02_f64
    ) {
        let polygon = Polygon::new(&convex_corners(count, seed, (0.4, 0.3)), radius).unwrap();
        let distance = |p: &Polygon, at: Vec2| {
            Surface::<Planar>::gap(&Shape::Polygon(p.clone()), at).distance
        };
        for point in points_about(seed, 20) {
            let here = distance(&polygon, point);
            let there = distance(&polygon.mirrored(), Vec2::new(-point.x, point.z));
            prop_assert!((here - there).abs() < 1e-14);
            // By a power of two to the bit, otherwise to rounding.
            prop_assert_eq!(4.0 * here, distance(&polygon.scaled(4.0), point * 4.0));
            prop_assert!((3.0 * here - distance(&polygon.scaled(3.0), point * 3.0)).abs() < 1e-14);
        }
    }
}

#[test]
fn what_is_no_convex_polygon_is_refused_with_the_corner() {
    let at = |points: &[(f64, f64)]| {
        Polygon::new(&points.iter().map(|p| Vec2::new(p.0, p.1)).collect::<Vec<_>>(), 0.0)
    };
    assert_eq!(at(&[(0.0, 0.0), (1.0, 0.0)]), Err(PolygonError::TooFew { found: 2 }));
    let not_convex = |corner, x, z| Err(PolygonError::NotConvex { corner, x, z });
    // Clockwise: the first corner already turns the wrong direction.
    assert_eq!(at(&[(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]), not_convex(1, 0.0, 0.0));
    // A dent.
    assert_eq!(at(&[(0.0, 0.0), (1.0, 0.0), (0.4, 0.4), (0.0, 1.0)]), not_convex(3, 0.4, 0.4));
    // In line with its neighbors.
    assert_eq!(at(&[(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 1.0)]), not_convex(2, 0.5, 0.0));
    // A repeated corner, and NaN.
    assert!(at(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)]).is_err());
    assert!(at(&[(0.0, 0.0), (1.0, f64::NAN), (0.0, 1.0)]).is_err());
    // A five-pointed star turns left at every corner, but goes around twice.
    let star: Vec<(f64, f64)> =
        (0..5).map(|i| polar(1.0, 2.0 * TAU * f64::from(i) / 5.0)).map(|p| (p.x, p.z)).collect();
    assert_eq!(at(&star), Err(PolygonError::Overlapping { corner: 3 }));
}

#[test]
fn corners_cannot_be_rounded_away() {
    assert!(Polygon::rectangle(0.6, 0.2, 0.099).is_ok());
    for radius in [0.1, 0.3, -0.01, f64::NAN] {
        let found = Polygon::rectangle(0.6, 0.2, radius);
        assert!(matches!(found, Err(PolygonError::RadiusTooLarge { .. })), "{radius}: {found:?}");
    }
    assert!(Polygon::rectangle(0.6, 0.0, 0.0).is_err());
    assert!(Polygon::rectangle(-0.6, 0.2, 0.0).is_err());
    assert!(Polygon::rectangle(0.6, f64::INFINITY, 0.0).is_err());
}

#[test]
fn what_is_no_barrel_has_no_profile() {
    assert!(BarrelProfile::new(0.95, 0.6, 0.7).is_some());
    for (length, head, bilge) in
        [(0.0, 0.6, 0.7), (0.95, 0.7, 0.6), (0.95, 0.0, 0.7), (0.95, f64::NAN, 0.7)]
    {
        assert!(BarrelProfile::new(length, head, bilge).is_none());
    }
}
