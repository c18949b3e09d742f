use barrelstack_dynamics::body::*;
use barrelstack_dynamics::shape::*;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::*;
use std::ops::ControlFlow;
struct Sine {
    a: f64,
    w: f64,
}
impl Drive<Planar> for Sine {
    fn at(&self, t: f64) -> (Vec2, Vec2) {
        let (s, c) = math::sin_cos(self.w * t);
        (Vec2::new(self.a * s, 0.0), Vec2::new(self.a * self.w * c, 0.0))
    }
}
struct Cosine {
    a: f64,
    w: f64,
}
impl Drive<Planar> for Cosine {
    fn at(&self, t: f64) -> (Vec2, Vec2) {
        let (s, c) = math::sin_cos(self.w * t);
        (Vec2::new(self.a * (1.0 - c), 0.0), Vec2::new(self.a * self.w * s, 0.0))
    }
}
struct Rec {
    dt: f64,
    a: Vec<f64>,
    v: Vec<f64>,
    d: Vec<f64>,
}
impl Drive<Planar> for Rec {
    fn at(&self, t: f64) -> (Vec2, Vec2) {
        let n = self.a.len();
        let k = ((t / self.dt) as usize).min(n - 2);
        let s = t - k as f64 * self.dt;
        if t >= (n - 1) as f64 * self.dt {
            let s = t - (n - 1) as f64 * self.dt;
            return (
                Vec2::new(self.d[n - 1] + self.v[n - 1] * s, 0.0),
                Vec2::new(self.v[n - 1], 0.0),
            );
        }
        let j = (self.a[k + 1] - self.a[k]) / self.dt;
        (
            Vec2::new(
                self.d[k] + self.v[k] * s + self.a[k] * s * s / 2.0 + j * s * s * s / 6.0,
                0.0,
            ),
            Vec2::new(self.v[k] + self.a[k] * s + j * s * s / 2.0, 0.0),
        )
    }
}
struct Obs {
    fell: Vec<Option<f64>>,
    seat: Vec<Option<f64>>,
    drift: f64,
    top: Vec<usize>,
    h: f64,
    static_max: Vec<f64>,
    dyn_max: Vec<f64>,
    first: Option<f64>,
    racks: Vec<usize>,
    tilt: Vec<f64>,
    barrels: Vec<usize>,
    rack_of: Vec<usize>,
    init: Vec<Vec2>,
    slip: f64,
    slip2: f64,
    quiet: bool,
}
impl Observer<Planar> for Obs {
    fn observe(
        &mut self,
        m: &Model<Planar>,
        s: &State<Planar>,
        sc: &Scratch<Planar>,
        _e: &EnergyLedger<Planar>,
    ) -> ControlFlow<()> {
        if self.quiet {
            return ControlFlow::Continue(());
        }
        if self.quiet {
            let r = _e.summary(0).residual;
            if (r - self.slip2).abs() > 0.3 {
                println!("t {:.4} residual {:.4} jump {:.4}", s.time, r, r - self.slip2);
            }
            self.slip2 = r;
        }
        for (k, &b) in self.barrels.iter().enumerate() {
            if self.fell[k].is_none() && s.poses[b].position.z < self.init[b].z - 0.45 {
                self.fell[k] = Some(s.time);
            }
            let r = self.rack_of[k];
            let rot = Rotation2::new(s.poses[r].orientation);
            let rel = rot.unapply(s.poses[b].position - s.poses[r].position);
            let rel0 = self.init[b] - self.init[r];
            let d = rel - rel0;
            if self.seat[k].is_none() && (d.x.abs() > 0.175 || d.z.abs() > 0.35) {
                self.seat[k] = Some(s.time);
                if self.first.is_none() {
                    self.first = Some(s.time);
                }
            }
        }
        if self.first.is_none() {
            let g = s.poses[0].position;
            self.slip = s.poses[self.racks[0]].position.x - g.x - self.init[self.racks[0]].x;
            for &t in &self.top {
                let d = s.poses[t].position.x - g.x - self.init[t].x;
                self.drift = self.drift.max((d / self.h).abs());
            }
            for (k, &r) in self.racks.iter().enumerate() {
                self.tilt[k] = self.tilt[k].max(s.poses[r].orientation.abs());
            }
            let mut mx = vec![0.0f64; m.bodies().len()];
            for c in &sc.contacts {
                let p = m.pairs()[c.pair];
                mx[p.target] = mx[p.target].max(c.normal_force);
            }
            if s.time == 0.0 {
                self.static_max = mx.clone();
            }
            for i in 0..mx.len() {
                self.dyn_max[i] = self.dyn_max[i].max(mx[i]);
            }
        }
        if let Some(f) = self.first {
            if s.time > f + 4.0 {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }
}
fn arg(name: &str, d: f64) -> f64 {
    for a in std::env::args() {
        if let Some(v) = a.strip_prefix(&format!("{name}=")) {
            return v.parse().unwrap();
        }
    }
    d
}
fn main() {
    let levels = arg("levels", 4.0) as usize;
    let cols = 2;
    let r = arg("r", 0.35);
    let pitch = arg("pitch", 0.76);
    let mb = arg("mb", 275.0);
    let mr = arg("mr", 30.0);
    let phi = arg("phi", 30.0f64).to_radians();
    let clr = arg("clr", 0.06);
    let bear = arg("bear", 0.08);
    let h = arg("h", 0.01);
    let k = arg("k", 9.8e5);
    let c = arg("c", 2200.0);
    let mug = arg("mug", 0.5);
    let mub = arg("mub", 0.22);
    let ktr = arg("ktr", 1.0);
    let ctr = arg("ctr", 1.0);
    let icoef = arg("icoef", 0.5);
    let full = arg("full", 0.0);
    let beam = arg("beam", 0.04);
    let dt = arg("dt", 1e-4);
    let nsup = arg("nsup", 1.0) as usize;
    let supw = arg("supw", 0.0f64).to_radians();
    let width = pitch + 0.74;
    let mut bodies = vec![];
    let gnd = Body {
        name: "ground".into(),
        motion: Motion::Prescribed,
        mass: 1.0,
        inertia: 1.0,
        damping: None,
        pose: Pose { position: Vec2::new(0.0, 0.0), orientation: 0.0 },
        twist: Twist::default(),
        surfaces: vec![Placed {
            surface: Shape::HalfPlane(HalfPlane),
            offset: Vec2::default(),
            rotation: Rotation2::identity(),
        }],
        nodes: vec![],
    };
    bodies.push(gnd);
    let mut pairs = vec![];
    let mut racks = vec![];
    let mut barrels = vec![];
    let mut rack_of = vec![];
    let lp = 2.0 * r + clr;
    for l in 0..levels {
        let z0 = l as f64 * lp; // underside
        let zc = z0 + 0.5 * beam;
        let xs: Vec<f64> =
            (0..cols).map(|j| (j as f64 - (cols as f64 - 1.0) / 2.0) * pitch).collect();
        let mut nodes = vec![];
        for &x in &xs {
            let n = (bear / h).round() as i64;
            if full > 0.0 {
                continue;
            }
            for i in -n..=n {
                nodes.push(Node {
                    position: Vec2::new(x + i as f64 * h, -0.5 * beam),
                    tributary_length: h,
                });
            }
        }
        if full > 0.0 {
            let n = (width / h).round() as i64;
            for i in 0..=n {
                nodes.push(Node {
                    position: Vec2::new(-width / 2.0 + i as f64 * h, -0.5 * beam),
                    tributary_length: h,
                });
            }
        } else {
            for x in [-width / 2.0, width / 2.0] {
                nodes.push(Node { position: Vec2::new(x, -0.5 * beam + 0.0), tributary_length: h });
            }
        }
        let mut sup = vec![];
        for &x in &xs {
            for s in [-1.0, 1.0] {
                for q in 0..nsup {
                    let a = s
                        * (phi
                            + if nsup > 1 {
                                supw * (q as f64 / (nsup as f64 - 1.0) - 0.5)
                            } else {
                                0.0
                            });
                    sup.push(Node {
                        position: Vec2::new(x + r * a.sin(), clr + r - r * a.cos() - 0.5 * beam),
                        tributary_length: h,
                    });
                }
            }
        }
        nodes.extend(sup);
        for x in [-width / 2.0, width / 2.0] {
            nodes.push(Node { position: Vec2::new(x, 0.5 * beam), tributary_length: h });
        }
        let id = bodies.len();
        racks.push(id);
        bodies.push(Body {
            name: format!("R{}", l + 1),
            motion: Motion::Free,
            mass: mr,
            inertia: mr * (width * width + beam * beam) / 12.0,
            damping: None,
            pose: Pose { position: Vec2::new(0.0, zc), orientation: 0.0 },
            twist: Twist::default(),
            surfaces: vec![Placed {
                surface: Shape::Polygon(Polygon::rectangle(width, beam, 0.0).unwrap()),
                offset: Vec2::default(),
                rotation: Rotation2::identity(),
            }],
            nodes: vec![Nodes::Fixed(nodes)],
        });
        for (j, &x) in xs.iter().enumerate() {
            let b = bodies.len();
            barrels.push(b);
            rack_of.push(id);
            bodies.push(Body {
                name: format!("B{}{}", l + 1, j + 1),
                motion: Motion::Free,
                mass: mb,
                inertia: icoef * mb * r * r,
                damping: None,
                pose: Pose { position: Vec2::new(x, z0 + clr + r), orientation: 0.0 },
                twist: Twist::default(),
                surfaces: vec![Placed {
                    surface: Shape::Circle(Circle { radius: r }),
                    offset: Vec2::default(),
                    rotation: Rotation2::identity(),
                }],
                nodes: vec![Nodes::Rolling {
                    center: Vec2::default(),
                    radius: r,
                    tributary_length: h,
                }],
            });
        }
    }
    let law = NormalLaw::SpeedGap { stiffness: k, damping: c };
    let iface = |n: &str, mu: f64| Interface {
        name: n.into(),
        normal: law,
        friction: FrictionLaw::Coulomb {
            static_coefficient: mu,
            kinetic_coefficient: mu,
            tangential_stiffness: k * ktr,
            tangential_damping: c * ctr,
        },
        basis: Basis::Node,
    };
    let ifs = vec![
        iface("rg", mug),
        iface("br", mub),
        iface("bb", 0.3),
        iface("bg", 0.5),
        iface("rr", 0.3),
    ];
    let pr = |a, t, i| ContactPair { contactor: a, nodes: 0, target: t, surface: 0, interface: i };
    for (x, &ra) in racks.iter().enumerate() {
        pairs.push(pr(ra, 0, 0));
        for &b in &barrels {
            pairs.push(pr(ra, b, 1));
        }
        for (y, &rb) in racks.iter().enumerate() {
            if x != y {
                pairs.push(pr(ra, rb, 4));
            }
        }
    }
    for (x, &b) in barrels.iter().enumerate() {
        pairs.push(pr(b, 0, 3));
        for &o in &barrels[x + 1..] {
            pairs.push(pr(b, o, 2));
        }
    }
    let model = Model::new(bodies, ifs, pairs, Vec2::new(0.0, -9.80665)).unwrap();
    let mut st = State::initial(&model);
    let mut sc = Scratch::new(&model);
    let t0 = std::time::Instant::now();
    let set = settle(&model, &mut st, &mut sc, dt.min(2e-4), 1e-9);
    println!("settle {:?} {:?}", set, t0.elapsed());
    let n = model.bodies().len();
    let init: Vec<Vec2> = st.poses.iter().map(|p| p.position).collect();
    let top: Vec<usize> = barrels[barrels.len() - cols..].to_vec();
    let mut o = Obs {
        fell: vec![None; barrels.len()],
        seat: vec![None; barrels.len()],
        drift: 0.0,
        top,
        h: levels as f64 * lp,
        static_max: vec![],
        dyn_max: vec![0.0; n],
        first: None,
        racks: racks.clone(),
        tilt: vec![0.0; racks.len()],
        barrels: barrels.clone(),
        rack_of,
        init: init.clone(),
        slip: 0.0,
        slip2: 0.0,
        quiet: arg("quiet", 0.0) > 0.0,
    };
    let end = arg("end", 20.0);
    let sim = Simulation {
        method: match arg("m", 1.0) as i32 {
            0 => Method::SemiImplicitEuler,
            2 => Method::RungeKutta4,
            3 => Method::BogackiShampine { tolerance: arg("tol", 1e-6) },
            _ => Method::VelocityVerlet,
        },
        time_step: dt,
        end_time: end,
    };
    let t1 = std::time::Instant::now();
    let w = 2.0 * std::f64::consts::PI / (0.76 * 2f64.sqrt());
    let amp = arg("amp", 0.1016);
    let fin =
        if let Some(p) = std::env::args().find_map(|a| a.strip_prefix("rec=").map(str::to_owned)) {
            let txt = std::fs::read_to_string(p).unwrap();
            let a: Vec<f64> = txt
                .lines()
                .skip(4)
                .flat_map(|l| {
                    l.split_whitespace()
                        .map(|x| x.parse::<f64>().unwrap() * 9.80665)
                        .collect::<Vec<_>>()
                })
                .collect();
            let d = 0.02;
            let (mut v, mut u) = (vec![0.0], vec![0.0]);
            for i in 1..a.len() {
                v.push(v[i - 1] + d * (a[i] + a[i - 1]) / 2.0);
                u.push(u[i - 1] + d * v[i - 1] + d * d * (a[i - 1] / 3.0 + a[i] / 6.0));
            }
            let pgv = v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let f = arg("pgv", 0.6) / pgv;
            let sc_ = |x: Vec<f64>| x.iter().map(|y| y * f).collect::<Vec<_>>();
            let rec = Rec { dt: d, a: sc_(a), v: sc_(v), d: sc_(u) };
            simulate(&model, &rec, &mut st, &mut sc, &sim, &mut o)
        } else if arg("cos", 0.0) > 0.0 {
            simulate(&model, &Cosine { a: amp, w }, &mut st, &mut sc, &sim, &mut o)
        } else {
            simulate(&model, &Sine { a: amp, w }, &mut st, &mut sc, &sim, &mut o)
        };
    let el = t1.elapsed().as_secs_f64();
    let fin = fin.unwrap();
    let e = fin.energy.summary(0);
    println!(
        "t_end {:.2} wall {:.3}s  x real time {:.0}  us/step {:.3} elements/eval {:.1} contacts now {}",
        st.time,
        el,
        st.time / el,
        el * 1e6 / fin.steps as f64,
        sc.contact_evaluations as f64 / sc.evaluations as f64,
        sc.contacts.len()
    );
    println!("first {:?} drift {:.2}% slip {:.3}", o.first, 100.0 * o.drift, o.slip);
    print!("fell ");
    for f in &o.fell {
        print!("{:?} ", f.map(|x| (x * 100.0).round() / 100.0));
    }
    println!();
    print!("seat ");
    for f in &o.seat {
        print!("{:?} ", f.map(|x| (x * 100.0).round() / 100.0));
    }
    println!();
    print!("ampl ");
    for &b in &barrels {
        print!("{:.2} ", o.dyn_max[b] / o.static_max[b]);
    }
    println!(
        " tilt(deg) {:?}",
        o.tilt.iter().map(|x| (x.to_degrees() * 100.0).round() / 100.0).collect::<Vec<_>>()
    );
    println!("energy {:?} ratio {:.2e}", e, e.residual_ratio());
}
