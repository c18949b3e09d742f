//! Every variant of every table is read, written and read back.

use std::f64::consts::PI;

use barrelstack_motion::IntensityMeasure;
use barrelstack_report::Language;

use barrelstack::scenario::{
    Amplitude, Basis, BodyOverride, Cradle, Damping, Fill, Friction, MeasuredOn, Method,
    MotionSource, Nodes, NormalLaw, PulseKind, RackKind, Scale, Scenario, Scene, Shape, StackBody,
    Vertical, Viscous,
};

fn stack(changes: &[&str]) -> Scenario {
    round_trip("candia-8-barrels", changes)
}

fn free(changes: &[&str]) -> Scenario {
    round_trip("rocking-block", changes)
}

fn round_trip(base: &str, changes: &[&str]) -> Scenario {
    let overrides: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    let scenario =
        Scenario::builtin(base, &overrides).unwrap_or_else(|error| panic!("{changes:?}: {error}"));
    let text = scenario.to_resolved_toml();
    let again =
        Scenario::parse("again.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(again, scenario, "{text}");
    assert_eq!(again.to_resolved_toml(), text);
    scenario
}

fn normal(changes: &[&str]) -> (Basis, NormalLaw) {
    let changes: Vec<String> =
        changes.iter().map(|c| format!("interface.rack-ground.{c}")).collect();
    let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
    let interface = stack(&changes).stack().unwrap().interfaces.rack_ground;
    (interface.basis, interface.normal)
}

#[test]
fn normal_laws() {
    let c = Damping::Coefficient;
    assert_eq!(
        normal(&["law=kelvin-voigt", "stiffness=1 MN/m", "damping=3 kN s/m"]),
        (Basis::Node, NormalLaw::KelvinVoigt { stiffness: 1e6, damping: c(3000.0) })
    );
    assert_eq!(
        normal(&["basis=length", "stiffness=98 MN/m^2", "damping=220 kN s/m^2"]),
        (Basis::Length, NormalLaw::SpeedGap { stiffness: 98e6, damping: c(220e3) })
    );
    assert_eq!(
        normal(&["restitution=0.8", "reference_mass=300 lb"]),
        (
            Basis::Node,
            NormalLaw::SpeedGap {
                stiffness: 980e3,
                damping: Damping::Restitution { restitution: 0.8, reference: 136.077_711 },
            }
        )
    );
    assert_eq!(
        normal(&["basis=length", "stiffness=98 MPa", "restitution=1", "reference_mass=500 kg/m"]),
        (
            Basis::Length,
            NormalLaw::SpeedGap {
                stiffness: 98e6,
                damping: Damping::Restitution { restitution: 1.0, reference: 500.0 },
            }
        )
    );
    assert_eq!(
        normal(&["law=hunt-crossley", "stiffness=1 MN/m^1.5", "damping=0.5 s/m"]),
        (Basis::Node, NormalLaw::HuntCrossley { stiffness: 1e6, exponent: 1.5, damping: c(0.5) })
    );
    assert_eq!(
        normal(&[
            "law=hunt-crossley",
            "stiffness=1 MN/m^1.5",
            "restitution=0.4",
            "reference_speed=3 m/s"
        ])
        .1,
        NormalLaw::HuntCrossley {
            stiffness: 1e6,
            exponent: 1.5,
            damping: Damping::Restitution { restitution: 0.4, reference: 3.0 }
        }
    );
    assert_eq!(
        normal(&["law=hunt-crossley", "exponent=1", "stiffness=1 MN/m", "damping=0.5 s/m"]),
        (Basis::Node, NormalLaw::HuntCrossley { stiffness: 1e6, exponent: 1.0, damping: c(0.5) })
    );
    assert_eq!(
        normal(&["law=hertz", "basis=length", "stiffness=1 MN/m^2.5"]),
        (Basis::Length, NormalLaw::Hertz { stiffness: 1e6 })
    );
}

#[test]
fn friction_laws() {
    let friction = |changes: &[&str]| {
        let changes: Vec<String> =
            changes.iter().map(|c| format!("interface.barrel-rack.friction{c}")).collect();
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        stack(&changes).stack().unwrap().interfaces.barrel_rack.friction
    };
    assert_eq!(friction(&[".law=none"]), Friction::None);
    // The coefficient of the base goes with its law; the pair has its own.
    assert_eq!(
        friction(&[".law=regularized", ".velocity=1 mm/s"]),
        Friction::Regularized { coefficient: 0.3, velocity: 1e-3 }
    );
    assert_eq!(
        friction(&[
            ".static_coefficient=0.3",
            ".tangential_stiffness_ratio=0.5",
            ".tangential_damping_ratio=0"
        ]),
        Friction::Coulomb {
            coefficient: 0.22,
            static_coefficient: 0.3,
            tangential_stiffness_ratio: 0.5,
            tangential_damping_ratio: 0.0,
        }
    );
}

#[test]
fn racks_and_cradles() {
    let posts = stack(&["stack.rack=rack-on-rack", "stack.rack.post_height=0.95 m"]);
    let rack = &posts.stack().unwrap().rack;
    assert_eq!(rack.kind, RackKind::OnRacks);
    assert_eq!(rack.posts.unwrap().height, 0.95);
    let four =
        stack(&["stack.rack.base=four-barrel", "stack.view=longitudinal", "stack.columns=4"]);
    assert_eq!(four.stack().unwrap().barrels_per_rack(), 2);
    assert_eq!(four.stack().unwrap().racks_per_level(), 2);
    let arc = stack(&[
        "stack.rack.cradle={ type = \"arc\", radius = \"0.34 m\", half_angle = \"40 deg\" }",
    ]);
    let Cradle::Arc { radius: 0.34, half_angle } = arc.stack().unwrap().rack.cradle else {
        panic!()
    };
    assert_eq!(half_angle, 40.0 / 180.0 * PI);
    let named = stack(&["stack.rack.cradle=supports"]);
    assert_eq!(named.stack().unwrap().rack.cradle, stack(&[]).stack().unwrap().rack.cradle);
}

#[test]
fn bodies_that_differ() {
    let scenario = stack(&[
        "stack.mirror=true",
        "stack.override=[{ level = 4, fill = \"empty\" }, { kind = \"rack\", level = 1, column = 1, mass = \"35 kg\", offset_x = \"-1 cm\" }]",
    ]);
    let stack = scenario.stack().unwrap();
    assert!(stack.mirror);
    let regular = BodyOverride {
        body: StackBody::Barrel,
        level: 4,
        column: None,
        row: None,
        mass: None,
        fill: Some(Fill::Empty),
        offset_x: 0.0,
        offset_y: 0.0,
    };
    assert_eq!(stack.overrides[0], regular);
    let rack = BodyOverride {
        body: StackBody::Rack,
        level: 1,
        column: Some(1),
        row: None,
        mass: Some(35.0),
        fill: None,
        offset_x: -0.01,
        offset_y: 0.0,
    };
    assert_eq!(stack.overrides[1], rack);
}

#[test]
fn pulses() {
    let cases: [(&str, PulseKind); 10] = [
        ("kind=ricker", PulseKind::Ricker),
        ("kind=half-sine", PulseKind::HalfSine),
        ("kind=one-sine", PulseKind::OneSine),
        ("kind=one-cosine", PulseKind::OneCosine),
        ("kind=rectangular", PulseKind::Rectangular),
        ("kind=gabor gamma=2", PulseKind::Gabor { gamma: 2.0, phase: 0.0 }),
        ("kind=cycloid-a", PulseKind::CycloidA),
        ("kind=cycloid-b", PulseKind::CycloidB),
        ("kind=cycloid-c cycles=2", PulseKind::CycloidC { cycles: 2 }),
        (
            "kind=mavroeidis-papageorgiou gamma=1.5 phase=1rad",
            PulseKind::MavroeidisPapageorgiou { gamma: 1.5, phase: 1.0 },
        ),
    ];
    for (fields, expected) in cases {
        let mut changes = vec![
            "motion.pulse.amplitude=0.5 m/s".to_owned(),
            "motion.pulse.frequency=2 Hz".to_owned(),
            "motion.pulse.direction=vertical".to_owned(),
        ];
        changes.extend(fields.split(' ').map(|field| format!("motion.pulse.{field}")));
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        let scenario = stack(&changes);
        let MotionSource::Pulse(pulse) = scenario.motion.source else { panic!("{fields}") };
        assert_eq!(pulse.kind, expected);
        assert_eq!(pulse.amplitude, Amplitude::Velocity(0.5));
        assert_eq!(pulse.period, 0.5);
    }
}

#[test]
fn motions() {
    let source = |changes: &[&str]| stack(changes).motion;
    assert_eq!(source(&["motion.none=true"]).source, MotionSource::None);
    let sine = source(&[
        "motion.sine.amplitude=0.3 g",
        "motion.sine.duration=10 s",
        "motion.sine.period=2 s",
    ]);
    let MotionSource::Sine(sine) = sine.source else { panic!() };
    assert_eq!((sine.amplitude, sine.cycles), (Amplitude::Acceleration(2.941_995), 5.0));
    let record = source(&[
        "motion.record=a.txt",
        "motion.vertical_record=b.txt",
        "motion.time_step=5 ms",
        "motion.unit=g",
        "motion.processing=none",
        "motion.scale.pga=0.4 g",
        "motion.similitude=0.5",
    ]);
    assert_eq!(record.scale, Scale::Pga(3.922_66));
    let MotionSource::Record(record) = record.source else { panic!() };
    assert_eq!((record.time_step, record.unit), (Some(0.005), Some(9.80665)));
    assert!(matches!(record.vertical, Vertical::File(file) if file.path == "b.txt"));
    let unit = source(&["motion.record=a.txt", "motion.unit=cm/s^2"]);
    let MotionSource::Record(record) = unit.source else { panic!() };
    assert_eq!(record.unit, Some(0.01));
    let counts = source(&["motion.record=a.mseed", "motion.sensitivity=427819"]);
    let MotionSource::Record(record) = counts.source else { panic!() };
    assert_eq!(record.sensitivity, Some(427_819.0));
    let measured = source(&[
        "motion.record=a.txt",
        "motion.scale.measure=sa(1,0.02)",
        "motion.scale.value=0.5 g",
        "motion.scale.of=rotd50",
    ]);
    let measure = IntensityMeasure::Sa { period: 1.0, damping: 0.02 };
    let of = MeasuredOn::RotD50;
    assert_eq!(measured.scale, Scale::Measure { measure, value: 4.903_325, of });
    let off = round_trip("demo-napa", &["motion.vertical=false", "motion.scale.factor=-2"]);
    let MotionSource::Record(record) = off.motion.source else { panic!() };
    assert_eq!((record.vertical, off.motion.scale), (Vertical::None, Scale::Factor(-2.0)));
}

#[test]
fn runs() {
    let method = |name: &str| stack(&[&format!("run.method={name}")]).run.method;
    assert_eq!(method("semi-implicit-euler"), Method::SemiImplicitEuler);
    assert_eq!(method("velocity-verlet"), Method::VelocityVerlet);
    assert_eq!(method("runge-kutta-4"), Method::RungeKutta4);
    assert_eq!(method("bogacki-shampine"), Method::BogackiShampine { tolerance: 1e-6 });
    let run = stack(&["run.step=0.1 ms", "run.gravity=1 g", "run.settle=false"]).run;
    assert_eq!((run.step, run.gravity, run.settle), (Some(1e-4), 9.80665, false));
    assert_eq!(stack(&["run.step=auto"]).run.step, None);
    let tight = stack(&["run.method=bogacki-shampine", "run.tolerance=1e-9"]).run;
    assert_eq!(tight.method, Method::BogackiShampine { tolerance: 1e-9 });
    let scenario = stack(&["outcome.fall_drop=1 ft", "record.frame_rate=30 Hz"]);
    let Scene::Stack { outcome, .. } = &scenario.scene else { panic!() };
    assert_eq!((outcome.fall_drop, scenario.record.frame_rate), (0.3048, 30.0));
}

#[test]
fn shapes_with_their_uniform_inertia() {
    // Outline, mass 12 kg, moment of inertia (kg·m²), center of mass (m).
    let cases: [(&str, f64, [f64; 2]); 6] = [
        (r#"{ type = "rectangle", width = "3 m", height = "4 m" }"#, 25.0, [0.0, 0.0]),
        // A cross of rectangles and four quarters of a disk.
        (
            r#"{ type = "rectangle", width = "2 m", height = "2 m", corner_radius = "0.5 m" }"#,
            12.0 * (11.0 / 6.0 + 5.0 * PI / 32.0) / (3.0 + PI / 4.0),
            [0.0, 0.0],
        ),
        (r#"{ type = "circle", radius = "2 m" }"#, 24.0, [0.0, 0.0]),
        (
            r#"{ type = "polygon", vertices = [["1 m","1 m"], ["4 m","1 m"], ["4 m","5 m"], ["1 m","5 m"]] }"#,
            25.0,
            [2.5, 3.0],
        ),
        // Half a circle of wire: depth 2 r/π.
        (
            r#"{ type = "cradle", radius = "1 m", half_angle = "90 deg" }"#,
            12.0 * (1.0 - 4.0 / (PI * PI)),
            [0.0, -2.0 / PI],
        ),
        (
            r#"{ type = "barrel-profile", length = "3 m", bilge_diameter = "4 m", head_diameter = "4 m" }"#,
            25.0,
            [0.0, 0.0],
        ),
    ];
    for (outline, inertia, center) in cases {
        let scenario = free(&[
            &format!("body.block.shape={outline}"),
            "body.block.mass=12 kg",
            "body.block.nodes.spacing=5 cm",
        ]);
        let Scene::Free(scene) = &scenario.scene else { panic!() };
        let body = &scene.bodies[0];
        assert!((body.inertia / inertia - 1.0).abs() < 1e-14, "{outline}: {}", body.inertia); // measured 6e-16
        for (found, expected) in body.center_of_mass.iter().zip(center) {
            assert!((found - expected).abs() < 1e-14, "{outline}: {found}"); // measured 0
        }
    }
}

#[test]
fn a_bulging_profile_has_the_inertia_of_the_polygon_through_it() {
    let shape = Shape::BarrelProfile { length: 0.945, bilge_diameter: 0.69, head_diameter: 0.555 };
    let radius = |x: f64| 0.345 - 0.0675 * (x / 0.4725).powi(2);
    let mut vertices: Vec<[f64; 2]> = (0..=2000)
        .map(|i| -0.4725 + 0.945 * f64::from(i) / 2000.0)
        .map(|x| [x, -radius(x)])
        .collect();
    let upper: Vec<[f64; 2]> = vertices.iter().rev().map(|[x, z]| [*x, -z]).collect();
    vertices.extend(upper);
    let polygon = Shape::Polygon { vertices };
    let ratio = shape.uniform().square_radius / polygon.uniform().square_radius;
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}"); // measured 2.4e-8
}

#[test]
fn bodies_of_free_scenes() {
    let scenario = free(&[
        "body.block.nodes.count=5",
        "body.block.fixed_to_ground=true",
        "body.block.viscous={ linear = \"2 N s/m\" }",
        "body.block.center_of_mass=[\"0 m\", \"-0.2 m\"]",
        "body.block.inertia=80 kg m^2",
        "body.block.spin=10 deg/s",
        "body.block.velocity=[\"1 m/s\", \"-2 ft/s\"]",
        "ground.slope=5 deg",
    ]);
    let Scene::Free(scene) = &scenario.scene else { panic!() };
    let body = &scene.bodies[0];
    assert_eq!(body.nodes, Nodes::Count(5));
    assert!(body.fixed_to_ground);
    assert_eq!(body.viscous, Some(Viscous { linear: 2.0, angular: 0.0 }));
    assert_eq!((body.inertia, body.center_of_mass), (80.0, [0.0, -0.2]));
    assert_eq!(body.velocity, [1.0, -0.6096]);
    assert_eq!(body.kind, "block");
    for (rule, expected) in
        [("corners", Nodes::Corners), ("{ spacing = \"1 in\" }", Nodes::Spacing(0.0254))]
    {
        let scenario = free(&[&format!("body.block.nodes={rule}")]);
        let Scene::Free(scene) = &scenario.scene else { panic!() };
        assert_eq!(scene.bodies[0].nodes, expected);
    }
}

#[test]
fn a_title_says_what_is_run() {
    let title = |text: &str, changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        Scenario::parse("mine.toml", text, &changes).unwrap().title
    };
    let own = "schema = 1\nextends = \"demo-napa\"\ntitle = \"Mine\"";
    assert_eq!(title(own, &[]), "Mine");
    assert_eq!(title(own, &["title=Yours", "stack.levels=4"]), "Yours");
    // A title of a built-in scenario, or a copy of it, would become untrue.
    let copied = Scenario::builtin("demo-napa", &[]).unwrap().to_resolved_toml();
    assert_eq!(
        title(&copied, &["stack.levels=4"]),
        "Eight barrels on four levels, South Napa 2014-08-24 M6.0"
    );
    let inherited = "schema = 1\nextends = \"candia-8-barrels\"\n[stack]\nlevels = 3";
    assert_eq!(title(inherited, &[]), "Six barrels on three levels, sine of 1.07 s");
    let own = "schema = 1\nextends = \"demo-napa\"\ntitle = \"Ten barrels on five levels, South Napa 2014\"";
    // In space the rows behind each other count, in a plane what it cuts.
    let rows = ["stack.levels=4", "stack.columns=4", "stack.columns_along=3"];
    let of = |view: &str| {
        title(own, &[&[view], &rows[..2 + usize::from(view.contains("spatial"))]].concat())
    };
    assert_eq!(of("stack.view=spatial"), "48 barrels on four levels, South Napa 2014-08-24 M6.0");
    assert!(of("stack.view=transverse").starts_with("16 barrels on four levels"));
}

#[test]
fn a_title_of_the_users_own_stays_and_what_is_changed_follows() {
    let own = "schema = 1\nextends = \"demo-napa\"\ntitle = \"My stack\"";
    let parsed = |text: &str, changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        Scenario::parse("mine.toml", text, &changes).unwrap()
    };
    let mine = |changes: &[&str]| parsed(own, changes);
    assert_eq!(mine(&["run.duration=5 s"]).title, "My stack");
    assert_eq!(mine(&["motion.record=a/my-site.AT2"]).title, "My stack: my-site.AT2");
    let both = mine(&["stack.levels=3", "motion.record=a/my-site.AT2"]);
    assert_eq!(both.title, "My stack: six barrels on three levels, my-site.AT2");
    assert_eq!(
        Language::Spanish.text(&both.title),
        "My stack: seis barricas en tres niveles, my-site.AT2"
    );
    assert_eq!(
        mine(&["interface.barrel-rack.friction.coefficient=0.2"]).title,
        "My stack, changed"
    );
    // A title that begins as a generated one, but names another motion, is the user's; one that only lacks a scale is not.
    let like = |motion: &str, changes: &[&str]| {
        let text = format!(
            "schema = 1\nextends = \"demo-napa\"\ntitle = \"Ten barrels on five levels, {motion}\"\n[motion.scale]\npga = \"0.5 g\""
        );
        parsed(&text, changes).title
    };
    let change = ["stack.levels=3"];
    assert_eq!(
        like("El Centro 1940", &change),
        "Ten barrels on five levels, El Centro 1940: six barrels on three levels"
    );
    assert_eq!(
        like("South Napa 2014", &change),
        "Six barrels on three levels, South Napa 2014-08-24 M6.0, at 0.50 g"
    );
    // Further changes do not repeat words, and neither do changes to the resolved text.
    let set =
        |scenario: &Scenario, change: &str| scenario.with(&[change.to_owned()]).unwrap().title;
    assert_eq!(set(&both, "stack.levels=2"), "My stack: four barrels on two levels, my-site.AT2");
    assert_eq!(set(&both, "stack.levels=5"), "My stack: my-site.AT2");
    let resolved = |changes: &[&str]| mine(changes).to_resolved_toml();
    let levels = ["stack.levels=2"];
    for changes in [&["stack.levels=3"][..], &["interface.barrel-rack.friction.coefficient=0.2"]] {
        let again = parsed(&resolved(changes), &levels).title;
        assert_eq!(again, "My stack: four barrels on two levels");
    }
    let file = ["motion.record=a/my-site.AT2"];
    assert_eq!(parsed(&resolved(&file), &levels).title, "My stack: four barrels on two levels");
    // A record in memory is a change like a record in a file.
    let record = barrelstack_motion::bundled("napa-college-2014").unwrap();
    let shaken = mine(&[]).with_record(&record).unwrap();
    assert!(shaken.title.starts_with("My stack: "), "{}", shaken.title);
    assert!(shaken.with_record(&record).unwrap().title == shaken.title);
    // What the title already says is not repeated.
    let named = own.replace("My stack", "My stack under my-site.AT2");
    assert_eq!(parsed(&named, &file).title, "My stack under my-site.AT2");
    // A generated title in a resolved text is not the user's own.
    let generated = Scenario::builtin("demo-napa", &["stack.levels=3".to_owned()]).unwrap();
    let again = parsed(&generated.to_resolved_toml(), &levels).title;
    assert!(again.starts_with("Four barrels on two levels, "), "{again}");
}
