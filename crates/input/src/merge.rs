//! Merges files and overrides in layers.
//!
//! Tables are merged key by key; any other value is replaced. A field of an upper layer also removes the lower layer's
//! fields with which it is mutually exclusive. If the upper layer selects another variant, the fields of the previous
//! variant are removed. An upper layer therefore never has to undo a lower layer.

use crate::error::{InputError, Problem};
use crate::field::{Default, Field, Kind, Section, Variant};
use crate::names::advice;
use crate::reader::item_name;
use crate::tree::{Entry, Node, Origin, Sources, Table, Value, parse_value};

/// Merges `over` into `base`; values of `over` take precedence.
pub fn overlay(base: &mut Table, over: Table, section: Option<&'static Section>) {
    let mut entries = over.entries;
    // The tag field goes first, because the meaning of the other keys depends on it.
    if let Some(variants) = section.and_then(|s| s.variants.as_ref()) {
        entries.sort_by_key(|entry| entry.key != variants.tag);
    }
    let keys: Vec<String> = entries.iter().map(|entry| entry.key.clone()).collect();
    for entry in entries {
        let inner = place_for(base, section, &entry.key, &entry.node.value, &keys);
        match (base.get_mut(&entry.key), entry.node.value) {
            (
                Some(Entry { node: Node { value: Value::Table(below), .. }, .. }),
                Value::Table(above),
            ) => overlay(below, above, inner),
            (_, value) => base.set(Entry {
                key: entry.key,
                origin: entry.origin,
                node: Node { origin: entry.node.origin, value },
            }),
        }
    }
}

/// Prepares `base` for the new value of a key, and returns the section of the key.
///
/// Removes the fields that are mutually exclusive with the key and, if the key selects another variant, the fields of
/// the previous variant. If the new value is a table but the existing value is a name that is short for a table,
/// expands the name, so that the two tables can be merged.
fn place_for(
    base: &mut Table,
    section: Option<&'static Section>,
    key: &str,
    value: &Value,
    together: &[String],
) -> Option<&'static Section> {
    let section = section?;
    for rival in section.rivals(key) {
        // Mutually exclusive keys in one layer are reported as a conflict, not merged.
        if !together.iter().any(|key| key == rival) {
            base.remove(rival);
        }
    }
    if let (Some(variants), Value::Text(new)) = (&section.variants, value)
        && variants.tag == key
        && let Some(old) = variant_of(base, section)
        && old.name != new
    {
        for field in old.fields {
            base.remove(field.name);
        }
    }
    let field = field_of(base, section, key)?;
    if let Kind::ChoiceOrTable(_, name_key, _) = field.kind
        && matches!(value, Value::Table(_))
        && let Some(entry) = base.get_mut(key)
    {
        expand_name(&mut entry.node, name_key);
    }
    field.kind.section()
}

fn variant_of(table: &Table, section: &'static Section) -> Option<&'static Variant> {
    let variants = section.variants.as_ref()?;
    let name = match table.get(variants.tag).map(|entry| &entry.node.value) {
        Some(Value::Text(name)) => name.clone(),
        Some(_) => return None,
        None => {
            let tag = section.fields.iter().find(|field| field.name == variants.tag)?;
            let Default::Value(text) = tag.default else { return None };
            let Value::Text(name) = parse_value(text, Origin::Default).value else { return None };
            name
        }
    };
    variants.list.iter().find(|variant| variant.name == name)
}

fn field_of(table: &Table, section: &'static Section, key: &str) -> Option<&'static Field> {
    let variant = variant_of(table, section);
    section.fields_of(variant).find(|field| field.name == key).or_else(|| section.any_field(key))
}

/// Replaces a name by a table that holds the name under `key`.
fn expand_name(node: &mut Node, key: &str) {
    if let Value::Text(name) = &node.value {
        let origin = node.origin;
        let inner = Node { origin, value: Value::Text(name.clone()) };
        let entry = Entry { key: key.to_owned(), origin, node: inner };
        node.value = Value::Table(Table { entries: vec![entry] });
    }
}

/// Expands every name that is short for a table, in this table and all nested tables.
pub fn expand_names(table: &mut Table, section: &'static Section) {
    let variant = variant_of(table, section);
    for field in section.fields_of(variant) {
        let Some(entry) = table.get_mut(field.name) else { continue };
        if let Kind::ChoiceOrTable(_, key, _) = field.kind {
            expand_name(&mut entry.node, key);
        }
        let Some(inner) = field.kind.section() else { continue };
        if let Value::Table(table) = &mut entry.node.value {
            expand_names(table, inner);
        } else if let Value::Array(items) = &mut entry.node.value {
            for item in items {
                if let Value::Table(table) = &mut item.value {
                    expand_names(table, inner);
                }
            }
        }
    }
}

/// Applies one override, written `path=value`; `index` is its index in [`Sources::overrides`].
fn apply_override(
    table: &mut Table,
    section: &'static Section,
    sources: &Sources,
    index: usize,
) -> Result<(), InputError> {
    let origin = Origin::Override(index);
    let wrong = |message: String| sources.error(origin, Problem::Inconsistent { message });
    let text = &sources.overrides[index];
    let Some((path, value)) = text.split_once('=') else {
        return Err(wrong(
            "an override must have the form path=value, such as `stack.levels=5`".to_owned(),
        ));
    };
    let keys: Vec<&str> = path.split('.').map(str::trim).collect();
    if keys.iter().any(|key| key.is_empty()) || keys.len() > 12 {
        return Err(wrong(format!(
            "`{}` is not a path to a field; write keys joined by dots, such as `run.step`",
            crate::quantity::shorten(path)
        )));
    }
    if value.trim().is_empty() {
        return Err(wrong(format!("`{}` has no value; write path=value", path.trim())));
    }
    set(table, Some(section), &keys, parse_value(value, origin)).map_err(wrong)
}

/// Returns the definition of the field at a path, or `None` if there is no such field. If several variants define the
/// field, the variant that the table selects takes precedence.
pub fn field_at(
    table: Option<&Table>,
    section: &'static Section,
    keys: &[&str],
) -> Option<&'static Field> {
    let (key, rest) = keys.split_first()?;
    let field = match table {
        Some(table) => field_of(table, section, key),
        None => section.any_field(key),
    }?;
    if rest.is_empty() {
        return Some(field);
    }
    let inner = field.kind.section()?;
    let node = table.and_then(|table| table.get(key)).map(|entry| &entry.node.value);
    if let Kind::Tables(_) = field.kind {
        // The next key is the name or the number of an item.
        let Some(Value::Array(items)) = node else { return None };
        let Value::Table(item) = &item_of(items, rest[0])?.value else { return None };
        return field_at(Some(item), inner, &rest[1..]);
    }
    let below = if let Some(Value::Table(below)) = node { Some(below) } else { None };
    field_at(below, inner, rest)
}

/// Returns the item of a list with the given name or number.
fn item_of<'a>(items: &'a [Node], wanted: &str) -> Option<&'a Node> {
    let named = |(index, item): &(usize, &Node)| {
        item_name(item, *index) == wanted || wanted == (index + 1).to_string()
    };
    items.iter().enumerate().find(named).map(|(_, item)| item)
}

/// Returns the origin of the value at a path, or `None` if there is no value.
///
/// Items of lists are identified by their name or their number, as in overrides.
pub fn origin_at(table: &Table, keys: &[&str]) -> Option<Origin> {
    node_at(table, keys).map(|node| node.origin)
}

/// Returns the value at a path together with its origin, or `None` if there is no value. Paths are as for
/// [`origin_at`].
pub fn node_at<'a>(table: &'a Table, keys: &[&str]) -> Option<&'a Node> {
    let (key, rest) = keys.split_first()?;
    let mut node = &table.get(key)?.node;
    let mut rest = rest;
    if let (Value::Array(items), [wanted, below @ ..]) = (&node.value, rest) {
        node = item_of(items, wanted)?;
        rest = below;
    }
    match (&node.value, rest) {
        (_, []) => Some(node),
        (Value::Table(below), _) => node_at(below, rest),
        _ => None,
    }
}

/// Returns `true` if any value of a table has this origin. Tables created only to hold a nested
/// value are ignored.
fn holds(table: &Table, origin: Origin) -> bool {
    fn inside(node: &Node, origin: Origin) -> bool {
        if let Value::Table(below) = &node.value {
            return holds(below, origin);
        }
        let items = if let Value::Array(items) = &node.value { items.as_slice() } else { &[] };
        node.origin == origin || items.iter().any(|item| inside(item, origin))
    }
    table.entries.iter().any(|entry| inside(&entry.node, origin))
}

/// Applies the overrides with index `first` and above, in order.
///
/// An override that replaces or removes the value of an earlier override is an error, unless it has the same text as
/// the earlier override.
pub fn apply_overrides(
    table: &mut Table,
    section: &'static Section,
    sources: &Sources,
    first: usize,
) -> Result<(), InputError> {
    let texts = &sources.overrides;
    let mut set: Vec<usize> = Vec::new();
    for index in first..texts.len() {
        apply_override(table, section, sources, index)?;
        let undone = |known: &&usize| !holds(table, Origin::Override(**known));
        if let Some(known) = set.iter().find(undone).filter(|known| texts[**known] != texts[index])
        {
            let message = format!(
                "this override contradicts `{}`; keep one of the two",
                crate::quantity::shorten(&texts[*known])
            );
            return Err(sources.error(Origin::Override(index), Problem::Inconsistent { message }));
        }
        set.retain(|known| holds(table, Origin::Override(*known)));
        set.extend(holds(table, Origin::Override(index)).then_some(index));
    }
    Ok(())
}

/// Sets the value at a path, creating missing tables along the path.
pub fn set(
    table: &mut Table,
    section: Option<&'static Section>,
    keys: &[&str],
    value: Node,
) -> Result<(), String> {
    let Some((key, rest)) = keys.split_first() else { return Ok(()) };
    let origin = value.origin;
    if rest.is_empty() {
        let entry = Entry { key: (*key).to_owned(), origin, node: value };
        overlay(table, Table { entries: vec![entry] }, section);
        return Ok(());
    }
    let empty = || Value::Table(Table::default());
    let inner = place_for(table, section, key, &empty(), &[]);
    if table.get(key).is_none() {
        let node = Node { origin, value: empty() };
        table.set(Entry { key: (*key).to_owned(), origin, node });
    }
    let Some(entry) = table.get_mut(key) else { return Ok(()) };
    match &mut entry.node.value {
        Value::Table(below) => set(below, inner, rest, value),
        Value::Array(items) => set_in_item(items, inner, key, rest, value),
        other @ (Value::Text(_)
        | Value::Integer(_)
        | Value::Float(_)
        | Value::Flag(_)
        | Value::Date) => {
            Err(format!("`{key}` is {} and has no field `{}`", other.describe(), rest[0]))
        }
    }
}

/// Sets a value inside one item of the list `key`; the path starts with the name or the number of
/// the item.
fn set_in_item(
    items: &mut [Node],
    section: Option<&'static Section>,
    key: &str,
    keys: &[&str],
    value: Node,
) -> Result<(), String> {
    let Some((wanted, rest)) = keys.split_first() else { return Ok(()) };
    let names: Vec<String> = items.iter().enumerate().map(|(i, item)| item_name(item, i)).collect();
    let number = || wanted.parse::<usize>().ok().filter(|n| (1..=items.len()).contains(n));
    let found = names.iter().position(|name| name == wanted).or_else(|| number().map(|n| n - 1));
    let Some(at) = found else {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        return Err(format!("`{key}` has no item `{wanted}`; {}", advice(wanted, &names)));
    };
    if let Value::Table(below) = &mut items[at].value
        && !rest.is_empty()
    {
        return set(below, section, rest, value);
    }
    Err(format!(
        "`{key}.{wanted}` is a whole item of a list; add a dot and the name of one of its fields"
    ))
}
