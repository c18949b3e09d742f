//! Correspondence between the paper's body numbers and our names.
//!
//! The paper shows numbers in its figures but does not list them. The text of the paper explains
//! some of the numbers: barrels 1, 4 and 7 are drawn together (Fig. 6c), bodies 11 and 10 are the
//! top barrels of four levels (section 4), bodies 2 and 3 are "barrel and racks" (Fig. 7c), and
//! along the barrels body 4 is "the rack from the second level". One rule satisfies all of these:
//! count level by level from the bottom, first the barrels of a level from the left, then its rack.

use barrelstack_report::{Cell, Table};

/// Returns our name for the body with the paper's `number`, in a stack with `columns` barrels per
/// level.
pub(super) fn name(number: u32, columns: u32) -> String {
    let level = (number - 1) / (columns + 1) + 1;
    let place = (number - 1) % (columns + 1) + 1;
    if place > columns { format!("R{level}") } else { format!("B{level}.{place}") }
}

/// Returns the paper's number of the body with our `name`; `None` for a body without a number.
pub(super) fn number(name: &str, columns: u32) -> Option<u32> {
    (1..=12 * (columns + 1)).find(|number| self::name(*number, columns) == name)
}

/// Builds the table of the paper's body numbers and our names of these bodies.
pub(super) fn table() -> Table {
    let pair =
        |number: u32, columns: u32| Cell::text(format!("{number} = {}", name(number, columns)));
    Table::of(
        "The paper's body numbers and the names on this page: B with level.column for barrels, R with the level for \
         racks. The paper does not list these numbers; the numbering was inferred from its text.",
        (1..=4).rev(),
        &[
            ("level", "", &|level: &u32| Cell::text(level.to_string())),
            ("transverse, left barrel", "", &|level| pair(3 * level - 2, 2)),
            ("transverse, right barrel", "", &|level| pair(3 * level - 1, 2)),
            ("transverse, rack", "", &|level| pair(3 * level, 2)),
            ("longitudinal, barrel", "", &|level| pair(2 * level - 1, 1)),
            ("longitudinal, rack", "", &|level| pair(2 * level, 1)),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::{name, number};

    #[test]
    fn the_rule_meets_every_number_that_the_text_explains() {
        assert_eq!([1, 4, 7].map(|n| name(n, 2)), ["B1.1", "B2.1", "B3.1"]);
        assert_eq!([10, 11].map(|n| name(n, 2)), ["B4.1", "B4.2"]);
        assert_eq!([2, 3].map(|n| name(n, 2)), ["B1.2", "R1"]);
        assert_eq!(name(4, 1), "R2");
    }

    #[test]
    fn numbers_and_names_are_each_others_inverse() {
        for columns in [1, 2] {
            for body in 1..=12 {
                assert_eq!(number(&name(body, columns), columns), Some(body));
            }
        }
        assert_eq!(number("ground", 2), None);
    }
}
