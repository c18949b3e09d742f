//! Protections of a stack: changes to the scenario, with their costs and their worn states.

use barrelstack::device::{Cost, DEVICES, Each, Setting};

use crate::scenario::{MotionSource, Scenario, ScenarioError, StackSpec, catalog};

/// Kind of a protection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The unprotected stack, as it is.
    AsItIs,
    /// Fewer levels.
    Height,
    /// Other racks.
    Rack,
    /// A device. The string is the name of the device in the singular.
    Device(&'static str),
    /// Two protections of different kinds together.
    Pair,
}

impl Kind {
    /// Returns the name used in JSON documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsItIs => "as-it-is",
            Self::Height => "height",
            Self::Rack => "rack",
            Self::Device(_) => "device",
            Self::Pair => "pair",
        }
    }
}

/// Protection of a stack: a single protection, or a combination of two.
#[derive(Clone, Debug, PartialEq)]
pub struct Protection {
    /// Kind of the protection.
    pub kind: Kind,
    /// Name of the folder for the studies of the protection: letters, digits and dashes.
    pub key: String,
    /// Name for display.
    pub name: String,
    /// Overrides that apply the protection to the scenario.
    pub changes: Vec<String>,
    /// Lower and upper cost for one stack (US$).
    pub cost: [f64; 2],
    /// Source of the cost.
    pub source: String,
    /// Number of barrels that the protection requires to be stored elsewhere.
    pub moved: u32,
    /// Worn states of the protection: for each, a description and further overrides of the scenario.
    pub degraded: Vec<(String, Vec<String>)>,
}

/// Lower and upper price (US$) of a new rack for two barrels.
///
/// The price was about US$100 in 2009 (cedarrivercellars.com). It is assumed that the price may have doubled
/// since.
const RACK: [f64; 2] = [100.0, 200.0];

/// Assumed lower and upper price (US$) of a rack on posts, which contains about twice as much steel as a rack
/// for two barrels.
const RACK_ON_POSTS: [f64; 2] = [200.0, 400.0];

/// Assumed lower and upper cost (US$) of storing a barrel elsewhere, that is, of half a rack and its floor
/// space.
const PLACE: [f64; 2] = [100.0, 300.0];

/// Returns the number of barrels on one level of a stack.
pub(super) fn a_level(stack: &StackSpec) -> u32 {
    stack.columns * stack.space.map_or(1, |space| space.columns_along)
}

/// Returns all single protections of a stack; the first is the unprotected stack.
pub(crate) fn singles(scenario: &Scenario) -> Vec<Protection> {
    let Some(stack) = scenario.stack() else { return Vec::new() };
    let (levels, columns) = (stack.levels, stack.columns);
    let along = stack.space.map_or(1, |space| space.columns_along);
    let per_rack = stack.rack.barrels.max(1);
    let none = |kind, key: &str, name: &str| Protection {
        kind,
        key: key.to_owned(),
        name: name.to_owned(),
        changes: Vec::new(),
        cost: [0.0, 0.0],
        source: String::new(),
        moved: 0,
        degraded: Vec::new(),
    };
    let mut all = vec![none(Kind::AsItIs, "as-it-is", "as it is")];
    for fewer in 1..levels {
        let kept = levels - fewer;
        let moved = fewer * a_level(stack);
        all.push(Protection {
            changes: vec![format!("stack.levels={kept}")],
            cost: times(PLACE, moved),
            source: "storage of the barrels elsewhere; assumption".to_owned(),
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
        let deep = rack.barrels_deep.max(1);
        // In a plane across the barrels, the price of a row of racks covers all barrels that these racks carry.
        let rows = if stack.space.is_some() { along.div_ceil(deep) } else { deep };
        let count = levels * columns.div_ceil(per_rack) * rows;
        let price = if rack.posts.is_some() { RACK_ON_POSTS } else { RACK };
        all.push(Protection {
            changes: vec![format!("stack.rack=\"{}\"", rack.base)],
            cost: times(price, count),
            source: "about US$100 for a rack of two barrels in 2009; it is assumed that racks on posts cost twice \
                     as much"
                .to_owned(),
            ..none(Kind::Rack, &format!("rack-{}", rack.base), &format!("{} racks", rack.base))
        });
    }
    let present = stack.devices.present();
    for words in DEVICES.iter().filter(|words| !present.contains(words)) {
        let device = |name: &str, changes: Vec<String>| Protection {
            cost: price(&words.cost, &changes, levels),
            source: words.cost.source.to_owned(),
            changes,
            degraded: words.degraded.iter().map(Setting::to_candidate).collect(),
            ..none(Kind::Device(words.one), &slug(name), name)
        };
        let settings = words.settings(levels);
        all.extend(settings.into_iter().map(|(name, changes)| device(&name, changes)));
    }
    all
}

/// Returns the lower and upper price (US$) of a device.
///
/// A price per level is multiplied by the number of levels that have the device. `changes` may set this number;
/// otherwise, it is `levels`, the number of levels of the stack.
fn price(cost: &Cost, changes: &[String], levels: u32) -> [f64; 2] {
    let set = |change: &String| change.split_once(".levels=")?.1.parse::<u32>().ok();
    let count = match cost.each {
        Each::Stack => 1,
        Each::Level => changes.iter().find_map(set).unwrap_or(levels),
    };
    times(cost.dollars, count)
}

/// Converts a name to a folder name of lower-case letters, digits and dashes.
pub(crate) fn slug(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let dashed: String = name.chars().map(plain).collect();
    dashed.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

/// Combines two protections: the second is applied to the stack that results from the first.
///
/// Returns `None` if both are of the same kind, since they then change the same fields. Also returns `None` if one of
/// them is the unprotected stack or itself a pair, or if the second does not fit the resulting stack.
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
        degraded: [first.degraded.clone(), second.degraded].concat(),
    })
}

/// Applies overrides to a scenario without reading a file.
pub(crate) fn changed(scenario: &Scenario, changes: &[String]) -> Result<Scenario, ScenarioError> {
    let mut still = scenario.clone();
    still.motion.source = MotionSource::None;
    let mut changed = Scenario::parse(&scenario.title, &still.to_resolved_toml(), changes)?;
    changed.motion = scenario.motion.clone();
    Ok(changed)
}

impl Protection {
    /// Applies the protection to a scenario.
    ///
    /// # Errors
    /// If the protection does not fit the stack.
    pub fn on(&self, scenario: &Scenario) -> Result<Scenario, ScenarioError> {
        changed(scenario, &self.changes)
    }

    /// Returns the worn states of the protection: for each, its description and the protection in that state.
    pub(super) fn worn(&self) -> impl Iterator<Item = (&str, Self)> {
        self.degraded.iter().enumerate().map(|(at, (words, changes))| {
            let field = |change: &String| change.split('=').next().map(str::to_owned);
            let own: Vec<_> = changes.iter().map(field).collect();
            let kept = self.changes.iter().filter(|change| !own.contains(&field(change)));
            let worn = Self {
                key: format!("{}-worn-{}", self.key, at + 1),
                name: format!("{}, {words}", self.name),
                changes: kept.chain(changes).cloned().collect(),
                degraded: Vec::new(),
                ..self.clone()
            };
            (words.as_str(), worn)
        })
    }
}

fn times(price: [f64; 2], count: u32) -> [f64; 2] {
    price.map(|price| price * f64::from(count))
}
