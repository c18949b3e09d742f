//! Tests of the sentences on the report page of safe heights.

use barrelstack::variants::ShareAt;
use barrelstack_fragility::{FitError, Monotony, Stripe};
use barrelstack_report::{Document, markdown};

use super::page::{document, synthetic};
use super::*;
use crate::decision::BandKind;

/// Returns a curve without a fit. `failures` gives the number of failures in 24 motions as a function of the
/// level of shaking.
fn curve(failures: impl Fn(f64) -> u32) -> LimitCurve {
    let stripe =
        |velocity: f64| Stripe { intensity: velocity, cases: 24, failures: failures(velocity) };
    let stripes: Vec<Stripe> = VELOCITIES.into_iter().map(stripe).collect();
    let monotony = Monotony {
        stripes: stripes.clone(),
        isotonic: Vec::new(),
        deviance: 0.0,
        p: 1.0,
        falls: Vec::new(),
    };
    LimitCurve {
        limit: LimitState::SeatLost,
        measure: 0,
        stripes,
        intervals: Vec::new(),
        fit: Err(FitError::Empty),
        grid: Vec::new(),
        band: Vec::new(),
        median: None,
        band_kind: BandKind::None,
        left_out: None,
        goodness: None,
        monotony,
        returned: Vec::new(),
    }
}

/// Returns an effect of the uncertain constants in which the friction of barrels is decisive.
///
/// The range of the share of stacks that collapse begins at 0. For shaking across the barrels, it ends at 2 % times the
/// number of levels; for any other direction, at 4 % times that number.
fn effect(levels: u32, direction: Direction) -> Fitted {
    let across = direction == Direction::Plane(View::Transverse);
    let highest = f64::from(levels) * if across { 0.02 } else { 0.04 };
    let at = |value, share| ShareAt { value, share, interval: [share, share] };
    let friction = Unknown {
        name: "friction of barrels on racks",
        field: "interface.barrel-rack.friction.coefficient",
        unit: "1",
        dispersion: 0.35,
        shares: (0..9)
            .map(|step| at(0.2 + 0.03 * f64::from(step), 0.1 * f64::from(step)))
            .collect(),
        difference: [0.3, 0.9],
        total: 0.9,
        width_if_measured: 0.1,
    };
    Fitted { range: [0.0, highest], as_stated: 0.0, decides: vec![friction] }
}

/// Returns results in which `failures` gives the number of stacks that collapse, as a function of levels,
/// direction and level of shaking.
fn made(failures: impl Fn(u32, View, f64) -> u32) -> Heights {
    let failures = |levels, direction, velocity| match direction {
        Direction::Plane(view) => failures(levels, view, velocity),
        Direction::Space => 0,
    };
    made_by(Request::default(), failures)
}

/// Returns results like those of [`made`], for the directions of a request.
fn made_by(request: Request, failures: impl Fn(u32, Direction, f64) -> u32) -> Heights {
    let across = Direction::Plane(View::Transverse);
    let height = |levels: u32, direction: Direction| Height {
        levels,
        direction,
        by_velocity: curve(|velocity| failures(levels, direction, velocity)),
        by_acceleration: curve(|velocity| failures(levels, direction, velocity)),
        fallen: vec![0.0; VELOCITIES.len()],
        effects: vec![Some(effect(levels, direction)); VELOCITIES.len()],
        static_margin: (direction != across).then(|| 9.806_65 * 0.6 / f64::from(levels)),
    };
    let of = |direction| request.heights().map(move |levels| (levels, direction));
    let stacks = request.directions().into_iter().flat_map(of);
    let heights = stacks.map(|(levels, direction)| height(levels, direction));
    Heights {
        heights: heights.collect(),
        request,
        recorded: Vec::new(),
        motions: 24,
        runs: 1440,
        left_out: 0,
        fallen_at_rest: 0,
        ends: Vec::new(),
        warnings: Vec::new(),
        document: Document::default(),
    }
}

#[test]
fn every_headline_says_the_rack_and_the_direction() {
    // Along the barrels, all stacks collapse above 24 cm/s. At 24 cm/s, one stack of six levels collapses.
    let along = |levels: u32, view: View, velocity: f64| match view {
        View::Transverse => 0,
        View::Longitudinal if velocity > 0.3 => 24,
        View::Longitudinal => u32::from(levels == 6 && velocity > 0.2),
    };
    let page = document(&made(along));
    assert_eq!(
        page.verdict.headline,
        "Up to 5 levels on two-barrel racks have a low risk in very strong shaking (24 cm/s), across the barrels and \
         along them: in 24 motions none fell (the probability of collapse is at most 12 % with 95 % confidence); in \
         severe shaking (36 cm/s), not even two levels have a low risk, along the barrels. Allowing for the \
         uncertain friction, stiffness and damping of the seats, up to 3 levels have a low risk: the probability of \
         collapse is 0 to 12 % (95 % range)."
    );
    // After one collapse in 24 runs, the upper bound of the probability is 18 %, which is not rated low.
    let one = document(&made(|_, view, _| u32::from(view == View::Transverse)));
    assert_eq!(
        one.verdict.headline,
        "Not even two levels on two-barrel racks have a low risk in strong shaking (12 cm/s), across the barrels."
    );
    let few = document(&Heights { motions: 5, ..made(along) });
    assert!(
        few.verdict
            .headline
            .contains("any stack on two-barrel racks as low risk: each stack was shaken by 5")
    );
}

#[test]
fn the_page_states_the_synthetic_motions_by_kind_and_which_values_are_assumed() {
    // Numbers and their units do not break on the page.
    let text = markdown(&document(&made(|_, _, _| 0)), "figures").text.replace('\u{a0}', " ");
    assert_eq!(Request::default().synthetic, 22);
    let motions = "Synthetic motions are added: 12 of M 6 at 8 km by Boore's method, 5 of M 7 at 20 km by Boore's \
                   method and 5 with a near-fault pulse.";
    assert!(text.contains(motions), "{text}");
    assert_eq!(synthetic(2), " Synthetic motions are added: 2 of M 6 at 8 km by Boore's method.");
    assert_eq!(synthetic(0), "");
    let friction = "These values and dispersions are assumptions. The friction of wet floors and of painted racks \
                    differs from these values";
    assert!(text.contains(friction), "{text}");
}

#[test]
fn static_margins_stand_beside_each_height() {
    let page = document(&made(|levels, view, velocity| {
        u32::from(view == View::Longitudinal && (levels == 6 || velocity > 0.2))
    }));
    let last = page.verdict.sentences.last().unwrap();
    assert_eq!(
        last,
        "Stacks of 6 levels have the smallest static margin, along the barrels: they collapse under a steady \
         horizontal acceleration of 0.10 g, which corresponds to a floor tilted by 6 degrees."
    );
    let text = markdown(&page, "figures").text.replace('\u{a0}', " ");
    for row in [
        "| 6 | along the barrels | 0.10 g | 5.7 | 12 cm/s |",
        "| 2 | along the barrels | 0.30 g | 17 | 24 cm/s |",
        "| 2 | across the barrels | above 1 g | – | at none |",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
}

#[test]
fn in_space_there_is_one_direction_and_no_word_of_planes() {
    let request = Request { in_space: true, ..Request::default() };
    let falls = |levels: u32, _, velocity: f64| match velocity {
        v if v > 0.3 => 24,
        v => u32::from(levels == 6 && v > 0.2),
    };
    let page = document(&made_by(request, falls));
    assert_eq!(
        page.verdict.headline,
        "Up to 5 levels on two-barrel racks have a low risk in very strong shaking (24 cm/s), shaken in all \
         directions: in 24 motions none fell (the probability of collapse is at most 12 % with 95 % confidence); in \
         severe shaking (36 cm/s), not even two levels have a low risk. Allowing for the uncertain friction, \
         stiffness and damping of the seats, up to 3 levels have a low risk: the probability of collapse is 0 to 12 \
         % (95 % range)."
    );
    let text = markdown(&page, "figures").text.replace('\u{a0}', " ");
    assert!(
        text.contains("| 6 | across or along the barrels | 0.10 g | 5.7 | 24 cm/s |"),
        "{text}"
    );
    for word in ["weaker direction", "in a plane model", "Both directions", "in one plane"] {
        assert!(!text.contains(word), "{word}\n{text}");
    }
}

#[test]
fn what_is_low_is_also_stated_over_the_uncertain_constants() {
    // Along the barrels, the range ends at 4 % per level, so that up to three levels do not exceed the limit of 12 %.
    let some = made(|levels, _, velocity| if levels < 5 && velocity < 0.3 { 0 } else { 24 });
    let headline = document(&some).verdict.headline;
    assert!(headline.contains("Up to 4 levels"), "{headline}");
    let over = "damping of the seats, up to 3 levels have a low risk: the probability of collapse is 0 to 12 % (95 % range).";
    assert!(headline.ends_with(over), "{headline}");
    // The table and the JSON document contain the same range.
    let text = markdown(&document(&some), "figures").text.replace('\u{a0}', " ");
    assert!(text.contains("0–12 %, friction of barrels on racks"), "{text}");
    let json = serde_json::to_value(some.to_document()).unwrap();
    let row = |levels: u32| {
        let all = json["heights"].as_array().unwrap();
        let of = |one: &&serde_json::Value| {
            one["levels"] == levels && one["direction"] == "longitudinal"
        };
        all.iter().find(of).unwrap()["at"][1].clone()
    };
    assert_eq!(row(3)["range"], serde_json::json!([0.0, 0.12]));
    assert_eq!(row(3)["decides"]["name"], "friction of barrels on racks");
    // If even two levels exceed the limit, the headline names the decisive constant.
    let mut wide = some;
    for height in &mut wide.heights {
        height.effects.iter_mut().flatten().for_each(|effect| effect.range[1] = 0.4);
    }
    let headline = document(&wide).verdict.headline;
    let over = "not even two levels have a low risk: the probability of collapse is 0 to 40 % (95 % range), along \
                the barrels; it depends most on the friction of barrels on racks.";
    assert!(headline.ends_with(over), "{headline}");
    // The headline names weaker shaking in which the limit is not exceeded.
    for height in &mut wide.heights {
        height.effects[0].as_mut().unwrap().range[1] = 0.1;
    }
    let headline = document(&wide).verdict.headline;
    let weaker = "on racks. In strong shaking (12 cm/s), up to 6 levels have a low risk.";
    assert!(headline.ends_with(weaker), "{headline}");
    // If the effect is unknown, the headline does not mention uncertain constants.
    wide.heights.iter_mut().for_each(|height| height.effects.fill(None));
    assert!(!document(&wide).verdict.headline.contains("uncertain"));
}
