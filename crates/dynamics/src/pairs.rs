//! Contact pairs of a model, listed one by one or generated from the kinds of the bodies.

use std::ops::Range;
use std::sync::Arc;

use crate::body::BodyId;
use crate::join::Crossing;
use crate::model::{ContactPair, Counts, InterfaceId};

/// Contact pairs of a model, grouped by their two bodies, in the order in which forces are summed.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Pairs {
    /// Every pair is stored.
    Listed {
        /// The pairs.
        pairs: Vec<ContactPair>,
        /// For every two bodies that have pairs, the indices of these pairs; sorted by the IDs of the bodies.
        couples: Vec<Couple>,
    },
    /// The pairs of two bodies depend only on the kinds of the bodies. So no list of all pairs is stored; its length
    /// would be quadratic in the number of bodies.
    OfKinds {
        /// The kind of every body.
        kinds: Vec<usize>,
        /// The pairs of two bodies, indexed by the kind of the body with the lower ID and then by the kind of the other
        /// body. In these pairs, the body with the lower ID is given as body 0 and the other body as body 1.
        meetings: Vec<Vec<Vec<ContactPair>>>,
        /// Number of pair indices that are reserved for each combination of two bodies.
        most: usize,
    },
    /// The pairs within each party are stored. The pairs between parties are derived from the contact kinds of the
    /// bodies, since the number of such pairs is quadratic in the number of bodies.
    Joined {
        /// The pairs within parties. The pairs between parties have higher indices.
        pairs: Vec<ContactPair>,
        /// For every two bodies of one party that have pairs, the indices of these pairs; sorted by the IDs of the
        /// bodies.
        couples: Vec<Couple>,
        /// Pairs between parties.
        foreign: Foreign,
    },
}

/// Contact pairs between bodies of different parties of a [joined](crate::join) model. A party is one of the runs that
/// are joined.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Foreign {
    /// Party and contact kind of every body.
    pub(crate) bodies: Vec<(usize, usize)>,
    /// For every party, its rank, and the index of its first interface. Where bodies of two parties touch, the party
    /// with the lower rank supplies the contact law.
    pub(crate) parties: Vec<(usize, InterfaceId)>,
    /// Rules for contacts between bodies of different parties.
    pub(crate) crossing: Arc<Crossing>,
    /// Number of pair indices that are reserved for each combination of two bodies.
    pub(crate) most: usize,
}

impl Foreign {
    /// Returns the contactor, the target and the interface of the pairs of two bodies, and how many node sets of the
    /// contactor and how many surfaces of the target may touch. Returns `None` if the bodies belong to one party or
    /// never touch.
    ///
    /// In the argument, the body with the lower ID comes first.
    #[inline(always)]
    fn of(&self, [a, b]: [BodyId; 2]) -> Option<(BodyId, BodyId, InterfaceId, [usize; 2])> {
        let ((first, one), (second, other)) = (self.bodies[a], self.bodies[b]);
        if first == second {
            return None;
        }
        let rule = self.crossing.rules[one][other]?;
        let ((rank, law), (other_rank, other_law)) = (self.parties[first], self.parties[second]);
        let law = if rank < other_rank { law + rule.laws[0] } else { other_law + rule.laws[1] };
        let kinds = &self.crossing.kinds;
        Some(if rule.reversed {
            (b, a, law, [kinds[other].nodes, kinds[one].surfaces])
        } else {
            (a, b, law, [kinds[one].nodes, kinds[other].surfaces])
        })
    }
}

/// Callback for one kind of contact pair: receives one pair of this kind, all bodies that may be the contactor, and all
/// bodies that may be the target.
pub type TellMeeting<'a> = dyn FnMut(&ContactPair, &[BodyId], &[BodyId]) + 'a;

/// Two bodies, and the indices of their pairs in the list of pairs.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Couple {
    /// The two bodies, the lower ID first.
    bodies: [BodyId; 2],
    /// Range of the indices of their pairs.
    pairs: Range<usize>,
}

/// Returns the two bodies of a pair, the lower ID first.
fn between(pair: &ContactPair) -> [BodyId; 2] {
    [pair.contactor.min(pair.target), pair.contactor.max(pair.target)]
}

impl Pairs {
    /// Creates [`Pairs::Listed`] from pairs in any order: sorts the pairs, removes duplicates and groups the pairs by
    /// their two bodies.
    pub(crate) fn listed(mut pairs: Vec<ContactPair>) -> Self {
        pairs.sort_unstable_by_key(|pair| (between(pair), *pair));
        pairs.dedup();
        let mut couples: Vec<Couple> = Vec::new();
        for (index, pair) in pairs.iter().enumerate() {
            match couples.last_mut() {
                Some(couple) if couple.bodies == between(pair) => couple.pairs.end = index + 1,
                _ => couples.push(Couple { bodies: between(pair), pairs: index..index + 1 }),
            }
        }
        Self::Listed { pairs, couples }
    }

    /// Creates the pairs of bodies from their kinds and `meet`; see [`Model::of_kinds`](crate::model::Model::of_kinds).
    pub(crate) fn of_kinds(
        kinds: Vec<usize>,
        meet: &dyn Fn([BodyId; 2]) -> Vec<ContactPair>,
    ) -> Self {
        let count = kinds.iter().max().map_or(0, |most| most + 1);
        let (mut first, mut last) = (vec![None; count], vec![0; count]);
        for (body, kind) in kinds.iter().enumerate() {
            first[*kind].get_or_insert(body);
            last[*kind] = body;
        }
        let of = |lower: usize, higher: usize| {
            let bodies = first[lower].map(|lower| [lower, last[higher]]);
            let Some(bodies) = bodies.filter(|[lower, higher]| lower < higher) else {
                return Vec::new();
            };
            let place = |body| usize::from(body == bodies[1]);
            let placed = |pair: ContactPair| ContactPair {
                contactor: place(pair.contactor),
                target: place(pair.target),
                ..pair
            };
            let mut pairs: Vec<ContactPair> = meet(bodies).into_iter().map(placed).collect();
            pairs.sort_unstable();
            pairs.dedup();
            pairs
        };
        let meetings: Vec<Vec<Vec<ContactPair>>> =
            (0..count).map(|a| (0..count).map(|b| of(a, b)).collect()).collect();
        let most = meetings.iter().flatten().map(Vec::len).max().unwrap_or(0);
        Self::OfKinds { kinds, meetings, most }
    }

    /// Returns the pair with the given index.
    #[inline(always)]
    pub(crate) fn get(&self, index: usize) -> ContactPair {
        match self {
            Self::Listed { pairs, .. } => pairs[index],
            Self::OfKinds { kinds, meetings, most } => {
                let (couple, at) = (index / most, index % most);
                let bodies = [couple / kinds.len(), couple % kinds.len()];
                let pair = meetings[kinds[bodies[0]]][kinds[bodies[1]]][at];
                ContactPair {
                    contactor: bodies[pair.contactor],
                    target: bodies[pair.target],
                    ..pair
                }
            }
            Self::Joined { pairs, foreign, .. } => {
                let Some(beyond) = index.checked_sub(pairs.len()) else { return pairs[index] };
                let (couple, at) = (beyond / foreign.most, beyond % foreign.most);
                let count = foreign.bodies.len();
                let found = foreign.of([couple / count, couple % count]);
                // Only indices from `of_couple` are passed.
                let (contactor, target, interface, [_, surfaces]) = found.unwrap_or_default();
                let (nodes, surface) = (at / surfaces.max(1), at % surfaces.max(1));
                let counts = Counts::Everywhere;
                ContactPair { contactor, nodes, target, surface, interface, counts }
            }
        }
    }

    /// Returns the index of a pair, or `None` if there is no such pair. The interface is ignored.
    pub(crate) fn number_of(&self, pair: &ContactPair) -> Option<usize> {
        let found = |number: &usize| {
            let at = self.get(*number);
            (at.contactor, at.nodes, at.target, at.surface, at.counts)
                == (pair.contactor, pair.nodes, pair.target, pair.surface, pair.counts)
        };
        self.of_couple(between(pair)).find(found)
    }

    /// Returns the index of the first pair between bodies of different parties.
    pub(crate) fn first_foreign(&self) -> usize {
        match self {
            Self::Listed { pairs, .. } | Self::Joined { pairs, .. } => pairs.len(),
            Self::OfKinds { .. } => usize::MAX,
        }
    }

    /// Returns the indices of the pairs of two bodies. In `bodies`, the lower ID comes first.
    pub(crate) fn of_couple(&self, bodies: [BodyId; 2]) -> Range<usize> {
        let listed = |couples: &[Couple]| {
            couples
                .binary_search_by_key(&bodies, |couple| couple.bodies)
                .map_or(0..0, |at| couples[at].pairs.clone())
        };
        match self {
            Self::Listed { couples, .. } => listed(couples),
            Self::Joined { pairs, couples, foreign } => {
                let [a, b] = bodies;
                if foreign.bodies[a].0 == foreign.bodies[b].0 {
                    return listed(couples);
                }
                foreign.of(bodies).map_or(0..0, |(.., [nodes, surfaces])| {
                    let first = pairs.len() + (a * foreign.bodies.len() + b) * foreign.most;
                    first..first + nodes * surfaces
                })
            }
            Self::OfKinds { kinds, meetings, most } => {
                let first = (bodies[0] * kinds.len() + bodies[1]) * most;
                first..first + meetings[kinds[bodies[0]]][kinds[bodies[1]]].len()
            }
        }
    }

    /// Returns the indices of all pairs in ascending order.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let (listed, bodies) = match self {
            Self::Listed { pairs, .. } => (pairs.len(), 0),
            Self::OfKinds { kinds, .. } => (0, kinds.len()),
            Self::Joined { pairs, foreign, .. } => (pairs.len(), foreign.bodies.len()),
        };
        let couples = (0..bodies).flat_map(move |a| (a + 1..bodies).map(move |b| [a, b]));
        let beyond = couples.flat_map(|couple| self.of_couple(couple));
        (0..listed).chain(beyond.filter(move |number| *number >= listed))
    }

    /// Calls `report` once for each kind of pair, with all bodies that may be its contactor and all bodies that may be
    /// its target. Pairs between the parties of a joined model are left out.
    pub(crate) fn each(&self, report: &mut TellMeeting<'_>) {
        match self {
            Self::Listed { pairs, .. } | Self::Joined { pairs, .. } => {
                for pair in pairs {
                    report(pair, &[pair.contactor], &[pair.target]);
                }
            }
            Self::OfKinds { kinds, meetings, .. } => {
                let mut members = vec![Vec::new(); meetings.len()];
                for (body, kind) in kinds.iter().enumerate() {
                    members[*kind].push(body);
                }
                for (lower, row) in meetings.iter().enumerate() {
                    for (higher, pairs) in row.iter().enumerate() {
                        for pair in pairs {
                            // First and last member, so that the two bodies differ even if they are of one kind.
                            let bodies =
                                [members[lower][0], members[higher][members[higher].len() - 1]];
                            let of = [&members[lower], &members[higher]];
                            let (contactor, target) = (bodies[pair.contactor], bodies[pair.target]);
                            let placed = ContactPair { contactor, target, ..*pair };
                            report(&placed, of[pair.contactor], of[pair.target]);
                        }
                    }
                }
            }
        }
    }
}
