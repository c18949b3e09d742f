//! What can be done for a stack: a change of the scenario, what it costs, and what is left of it when worn.

use crate::scenario::{MotionSource, Scenario, ScenarioError, catalog};

/// What kind of change it is; of a kind only one is part of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The stack as it is.
    AsItIs,
    /// Fewer levels.
    Height,
    /// Other racks.
    Rack,
    /// Straps.
    Straps,
    /// Two of these at once.
    Pair,
}

impl Kind {
    /// The word in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsItIs => "as-it-is",
            Self::Height => "height",
            Self::Rack => "rack",
            Self::Straps => "straps",
            Self::Pair => "pair",
        }
    }
}

/// One thing that can be done for a stack, or two at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Protection {
    /// Its kind.
    pub kind: Kind,
    /// Name of its folder, of letters, digits and dashes.
    pub key: String,
    /// Its name for people.
    pub name: String,
    /// What it changes, as overrides of the scenario.
    pub changes: Vec<String>,
    /// What it costs for a stack (US$), from and to.
    pub cost: [f64; 2],
    /// Where the cost comes from.
    pub source: String,
    /// Barrels that have to stand elsewhere.
    pub moved: u32,
    /// What it is when worn or badly fitted: in words, and as further overrides; none where it cannot wear.
    pub degraded: Option<(String, Vec<String>)>,
}

/// Price (US$) of a new rack for two barrels: about 100 in 2009 (cedarrivercellars.com); that it may be twice as much
/// by now is an assumption.
const RACK: [f64; 2] = [100.0, 200.0];

/// The same of a rack on posts, which has some twice the steel: an assumption.
const RACK_ON_POSTS: [f64; 2] = [200.0, 400.0];

/// Price (US$) of a strap with its ratchet, put on: an assumption.
const STRAP: [f64; 2] = [15.0, 40.0];

/// Cost (US$) of a barrel's place elsewhere, half a rack and its floor: an assumption.
const PLACE: [f64; 2] = [100.0, 300.0];

/// Pretensions (kN) of straps that are tried; by hand a ratchet for webbing of 50 mm reaches 5 kN at most.
const PRETENSIONS: [u32; 3] = [1, 3, 5];

/// All that can be done for a stack, which as it is comes first.
pub(super) fn singles(scenario: &Scenario) -> Vec<Protection> {
    let Some(stack) = scenario.stack() else { return Vec::new() };
    let (levels, columns) = (stack.levels, stack.columns);
    let per_rack = stack.rack.barrels.max(1);
    let none = |kind, key: &str, name: &str| Protection {
        kind,
        key: key.to_owned(),
        name: name.to_owned(),
        changes: Vec::new(),
        cost: [0.0, 0.0],
        source: String::new(),
        moved: 0,
        degraded: None,
    };
    let mut all = vec![none(Kind::AsItIs, "as-it-is", "as it is")];
    for fewer in 1..levels {
        let kept = levels - fewer;
        let moved = fewer * columns;
        all.push(Protection {
            changes: vec![format!("stack.levels={kept}")],
            cost: times(PLACE, moved),
            source: "places for the barrels elsewhere; assumption".to_owned(),
            moved,
            ..none(
                Kind::Height,
                &format!("levels-{kept}"),
                &format!("{kept} level{}", if kept == 1 { "" } else { "s" }),
            )
        });
    }
    let racks = catalog::RACKS.iter().map(|known| &known.rack);
    for rack in racks.filter(|rack| rack.base != stack.rack.base && rack.barrels == per_rack) {
        let count = levels * columns.div_ceil(per_rack) * rack.barrels_deep;
        let price = if rack.posts.is_some() { RACK_ON_POSTS } else { RACK };
        all.push(Protection {
            changes: vec![format!("stack.rack=\"{}\"", rack.base)],
            cost: times(price, count),
            source: "about US$100 for a rack of two barrels in 2009; that racks on posts cost twice as much is an \
                     assumption"
                .to_owned(),
            ..none(Kind::Rack, &format!("rack-{}", rack.base), &format!("racks `{}`", rack.base))
        });
    }
    if stack.devices.strap.levels == 0 && levels > 1 {
        // Three levels as one block, and the whole stack.
        let blocks = if levels > 3 { vec![3, levels] } else { vec![levels] };
        for strapped in blocks {
            for pretension in PRETENSIONS {
                let (which, part) = if strapped == levels {
                    ("all levels".to_owned(), "all".to_owned())
                } else {
                    (format!("top {strapped} levels"), format!("top-{strapped}"))
                };
                let table = |pretension: &str| {
                    format!(
                        "stack.strap={{ levels = {strapped}, ties = \"levels-together\", {pretension} }}"
                    )
                };
                // Two down the sides of every barrel, and two between racks.
                let count =
                    2 * strapped * columns + 2 * (strapped - 1) * columns.div_ceil(per_rack);
                all.push(Protection {
                    changes: vec![table(&format!("pretension = \"{pretension} kN\""))],
                    cost: times(STRAP, count),
                    source: "a strap and its ratchet, put on; assumption".to_owned(),
                    degraded: Some(("loose by 20 mm".to_owned(), vec![table("slack = \"20 mm\"")])),
                    ..none(
                        Kind::Straps,
                        &format!("straps-{part}-at-{pretension}-kn"),
                        &format!("{which} strapped together at {pretension} kN"),
                    )
                });
            }
        }
    }
    all
}

/// Two at once, the second for the stack that the first leaves; none of one kind, since each changes the same fields,
/// and none where the second does not go on that stack.
pub(super) fn pair(
    scenario: &Scenario,
    one: &Protection,
    other: &Protection,
) -> Option<Protection> {
    let whole = [Kind::AsItIs, Kind::Pair];
    if one.kind == other.kind || whole.contains(&one.kind) || whole.contains(&other.kind) {
        return None;
    }
    let [first, second] = if one.kind < other.kind { [one, other] } else { [other, one] };
    let left = changed(scenario, &first.changes).ok()?;
    let second = singles(&left).into_iter().find(|single| single.key == second.key)?;
    let join = |texts: [&str; 2], by: &str| {
        texts.into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(by)
    };
    Some(Protection {
        kind: Kind::Pair,
        key: join([&first.key, &second.key], "-and-"),
        name: join([&first.name, &second.name], ", "),
        changes: [&first.changes[..], &second.changes[..]].concat(),
        cost: [0, 1].map(|at| first.cost[at] + second.cost[at]),
        source: join([&first.source, &second.source], "; "),
        moved: first.moved + second.moved,
        degraded: second.degraded.or_else(|| first.degraded.clone()),
    })
}

/// A scenario with overrides, whatever it was made with; nothing is read from the disk.
fn changed(scenario: &Scenario, changes: &[String]) -> Result<Scenario, ScenarioError> {
    let mut still = scenario.clone();
    still.motion.source = MotionSource::None;
    let mut changed = Scenario::parse(&scenario.title, &still.to_resolved_toml(), changes)?;
    changed.motion = scenario.motion.clone();
    Ok(changed)
}

impl Protection {
    /// A scenario with it.
    ///
    /// # Errors
    /// When it does not fit.
    pub fn on(&self, scenario: &Scenario) -> Result<Scenario, ScenarioError> {
        changed(scenario, &self.changes)
    }

    /// The same when it is worn or badly fitted; none where it cannot wear.
    pub(super) fn worn(&self) -> Option<Self> {
        let (words, changes) = self.degraded.as_ref()?;
        let keys: Vec<&str> =
            changes.iter().filter_map(|change| change.split('=').next()).collect();
        let kept = self
            .changes
            .iter()
            .filter(|change| change.split('=').next().is_none_or(|key| !keys.contains(&key)));
        Some(Self {
            key: format!("{}-worn", self.key),
            name: format!("{}, {words}", self.name),
            changes: kept.chain(changes).cloned().collect(),
            degraded: None,
            ..self.clone()
        })
    }
}

fn times(price: [f64; 2], count: u32) -> [f64; 2] {
    price.map(|price| price * f64::from(count))
}
