//! Reads a factor of a study file: the fields that it sets, and their values.

use barrelstack_report::column::{ColumnSpec, Role};

use crate::scenario::reader::Reader;
use crate::scenario::template::Template;
use crate::scenario::tree::Node;
use crate::scenario::{Scenario, ScenarioError};
use crate::study::distribution::Distribution;
use crate::study::setting::{Domain, Setting};
use crate::study::{Factor, Variation, rows};

/// Lowest cumulative probability whose quantile is tested before any run, for a continuous distribution. The highest
/// such probability is 1 − `LOW`.
pub(super) const LOW: f64 = 1e-6;

/// Returns an error if a new factor has the same column as another factor, or sets the same field.
pub(super) fn clash(top: &Reader<'_>, factors: &[Factor], new: &Factor) -> Option<ScenarioError> {
    let error = |message| Some(top.inconsistent("factor", message));
    for factor in factors {
        if factor.name == new.name {
            return error(format!(
                "two factors have the name `{}`; give one of them a different `name`",
                new.name
            ));
        }
        if let Some(field) = new.fields.iter().find(|field| factor.fields.contains(field)) {
            return error(format!(
                "the factors `{}` and `{}` both set {field}",
                factor.name, new.name
            ));
        }
    }
    if rows::fixed_columns().any(|column| column == new.name) {
        return error(format!(
            "every table has a column `{}`; give the factor a different `name`",
            new.name
        ));
    }
    None
}

/// Limits on the number of factor values and on the number of cases of a study. They are checked before any value is
/// tested, so that a study that is too large is rejected before it takes time or memory.
#[derive(Debug)]
pub(super) struct Room {
    /// Number of values that may still be listed.
    values: usize,
    /// Number of cases so far and maximum number of cases; `None` if the design does not combine all values.
    cases: Option<(u64, u64)>,
}

/// Maximum total number of values, over all factors of a study.
const MOST_VALUES: usize = 20_000;

impl Room {
    /// Creates the limits for a study with `motions` motions. `most` is the maximum number of cases; `None` if the
    /// design does not combine all values.
    pub(super) fn new(motions: usize, most: Option<u64>) -> Self {
        Self { values: MOST_VALUES, cases: most.map(|most| (motions as u64, most)) }
    }

    /// Counts the values of a factor toward the limits; returns an error if a limit is exceeded.
    fn take(&mut self, reader: &Reader<'_>, values: &[Setting]) -> Result<(), ScenarioError> {
        let key = if reader.has("range") { "range" } else { "values" };
        let Some(left) = self.values.checked_sub(values.len()) else {
            let message = format!(
                "all factors of the study have more than {MOST_VALUES} values in total: give this factor fewer values, \
                 or a `distribution` in a sampled design such as \"sobol\""
            );
            return Err(reader.inconsistent(key, message));
        };
        self.values = left;
        if let Some((cases, most)) = &mut self.cases {
            *cases = cases.saturating_mul(values.len() as u64);
            if *cases > *most {
                let message = format!(
                    "with the {} values of this factor the study has more than {most} cases: use fewer values, or a \
                     sampled design such as \"sobol\"",
                    values.len()
                );
                return Err(reader.inconsistent(key, message));
            }
        }
        Ok(())
    }
}

pub(super) fn read_factor(
    reader: Reader<'_>,
    template: &Template,
    scenario: &Scenario,
    own_motion: bool,
    room: &mut Room,
) -> Result<Factor, ScenarioError> {
    let field = reader.text("field")?.trim().to_owned();
    let name = reader.optional_text("name")?.unwrap_or_else(|| field.clone());
    let mut fields = vec![field.clone()];
    fields.extend(reader.texts("also")?.into_iter().map(|text| text.trim().to_owned()));
    let mut domain = None;
    for (index, path) in fields.iter().enumerate() {
        let of = domain_of(
            &reader,
            if index == 0 { "field" } else { "also" },
            path,
            template,
            own_motion,
        )?;
        if domain.get_or_insert(of) != &of {
            let message = format!(
                "`{path}` and `{field}` need different kinds of values, so one factor cannot set \
                 both"
            );
            return Err(reader.inconsistent("also", message));
        }
    }
    let Some(domain) = domain else { return Err(reader.missing("field")) };
    let (variation, domain) = read_variation(&reader, domain, "values")?;
    let Some(variation) = variation else {
        return Err(reader.one_of(&["values", "range", "distribution"]));
    };
    if let Variation::Values(values) = &variation {
        room.take(&reader, values)?;
    }
    reader.finish();
    // Each value is tested on its own before any run, so that an error states the place of the invalid value in the
    // file.
    let ends: Vec<Setting> = match &variation {
        Variation::Values(values) => values.clone(),
        Variation::Distribution(distribution) => match distribution.settings() {
            Some(settings) => settings.cloned().collect(),
            None => [LOW, 0.5, 1.0 - LOW].map(|u| distribution.quantile(u)).to_vec(),
        },
    };
    let mut in_space = false;
    for setting in &ends {
        let changes = fields.iter().map(|field| (field.as_str(), &setting.node));
        in_space |= template.with(changes)?.is_spatial();
    }
    let base = Template::value_in(scenario, &field).and_then(|value| domain.base_value(&value));
    let column = ColumnSpec::new(&name, &domain.unit(), Role::Factor, domain.column_kind());
    let structural = !domain.continuous();
    Ok(Factor { name, fields, variation, column, base, structural, in_space })
}

fn domain_of(
    reader: &Reader<'_>,
    key: &str,
    path: &str,
    template: &Template,
    own_motion: bool,
) -> Result<Domain, ScenarioError> {
    let Some(field) = template.field(path) else {
        let message = format!(
            "a scenario has no field `{path}`{}",
            template
                .nearest(path)
                .map_or(String::new(), |near| format!(", did you mean `{near}`?"))
        );
        return Err(reader.inconsistent(key, message));
    };
    if path.starts_with("motion.") && !own_motion {
        let message = format!("`{path}` is set by [[motion]]; vary it there");
        return Err(reader.inconsistent(key, message));
    }
    if matches!(path, "motion.record" | "motion.vertical_record") {
        // The contents of these files are part of the fingerprint of the study only where [[motion]] lists them.
        let message = format!(
            "`{path}` names a file, which a factor cannot vary; list the files as `records` of \
             [[motion]]"
        );
        return Err(reader.inconsistent(key, message));
    }
    if matches!(path, "title" | "schema" | "extends") || path.starts_with("record.") {
        let message = format!("`{path}` has no effect on the stack; name another field");
        return Err(reader.inconsistent(key, message));
    }
    Domain::of(field).ok_or_else(|| {
        let message = format!(
            "`{path}` holds {}, but a factor varies a single value: name one of its fields",
            field.kind
        );
        reader.inconsistent(key, message)
    })
}

/// Returns the first value that a range or a distribution states; `None` if it states none. This value determines the
/// dimension of the factor.
fn first_of(section: &Reader<'_>) -> Result<Option<Node>, ScenarioError> {
    match ["from", "mean", "median", "values"].into_iter().find(|key| section.has(key)) {
        Some("values") => Ok(section.nodes("values")?.and_then(|nodes| nodes.first().cloned())),
        Some(key) => section.node(key),
        None => Ok(None),
    }
}

/// Reads a list under the key `list`, a range or a distribution. The variation is `None` if none of these is
/// present.
pub(super) fn read_variation(
    reader: &Reader<'_>,
    domain: Domain,
    list: &'static str,
) -> Result<(Option<Variation>, Domain), ScenarioError> {
    let listed = reader.nodes(list)?;
    let range = reader.optional_section("range")?;
    let distribution = reader.optional_section("distribution")?;
    let first = match (listed, range.as_ref().or(distribution.as_ref())) {
        (Some(nodes), _) => nodes.first().cloned(),
        (None, Some(section)) => first_of(section)?,
        (None, None) => None,
    };
    let domain = first.as_ref().map_or(domain, |node| domain.fixed_by(node));
    let variation = if reader.has(list) {
        Some(Variation::Values(domain.settings(reader, list)?))
    } else if let Some(range) = range {
        let origin = reader.origin_of("range");
        let values = domain.range(&range, origin)?;
        range.finish();
        Some(Variation::Values(values))
    } else if let Some(distribution) = distribution {
        let origin = reader.origin_of("distribution");
        Some(Variation::Distribution(Distribution::read(distribution, domain, origin)?))
    } else {
        None
    };
    Ok((variation, domain))
}
