use barrelstack_motion::*;
fn main() {
    let mut motions = vec![(
        "napa",
        bundled("napa-college-2014")
            .unwrap()
            .ground_motion(
                &Component::Horizontal1,
                None,
                &Processing { pads: Pads::Removed, ..Processing::raw() },
            )
            .unwrap(),
    )];
    for f in ["peer/RSN995_NORTHR_PEL360.AT2", "peer/IELC180.AT2", "renadic/curico1002271parte1.v1"]
    {
        let b = std::fs::read(format!("/work/shared/ground-motions/{f}")).unwrap();
        motions.push((f, read(&b, f, &ReadOptions::default()).unwrap().default_motion().unwrap()));
    }
    let targets = [
        TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0 },
        TargetSpectrum::Eurocode8 {
            ground_acceleration: 0.3,
            site: SiteClass::B,
            small_magnitude: false,
            damping: 0.05,
        },
        TargetSpectrum::NCh433 { zone: ChileanZone::Three, site: SiteClass::D },
        TargetSpectrum::NCh2745 { zone: ChileanZone::Two, soil: NCh2745Soil::II },
        TargetSpectrum::Nzs1170 {
            hazard: 0.4,
            return_period: 1.0,
            site: SiteClass::C,
            fault_distance: None,
        },
    ];
    for (n, m) in &motions {
        for t in &targets {
            for method in [MatchMethod::Frequency, MatchMethod::Time] {
                let s = Matching { method, ..Matching::default() };
                let t0 = std::time::Instant::now();
                match m.match_spectrum(t, &s) {
                    Ok(r) => println!(
                        "{n} {method:?} misfit {:.4} rounds {} PGV {:.3} PGD {:.3} {:?}",
                        r.misfit,
                        r.rounds,
                        r.motion.pgv(),
                        r.motion.pgd(),
                        t0.elapsed()
                    ),
                    Err(e) => println!("{n} {method:?} {e} {:?}", t0.elapsed()),
                }
            }
        }
    }
}
