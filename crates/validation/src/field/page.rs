//! Markdown page of the hindcasts.

use std::fmt::Write as _;

use barrelstack_fragility::wilson;

use super::cases::FieldCases;
use super::results::{Bin, FRICTION, GROUND, Posterior, Results, STIFFNESS, Share};
use super::weigh::{DRAWS, Range};
use barrelstack_calibration::shares::{Earthquake, MODEL_ERROR, Statements};

const HEAD: &str = "\
# Hindcasts: real earthquakes compared with the model

<!-- Written by `cargo xtask field` from field/observations.toml and field/cases; change those, not this page. -->

This page compares observations of barrel stacks in real earthquakes with the predictions of the model. It also gives \
the likelihood of these observations for different values of the constants that nobody has measured.
Nobody has published counts of fallen stacks by height, direction or floor for any earthquake. The observations \
therefore do not suffice to calibrate the constants.

```sh
cargo xtask field --records DIR    # runs what is not yet run, and writes this page
cargo xtask field --page           # writes this page from the cases that are there
```

The observations are listed in [field/observations.toml](field/observations.toml).
The results are in three tables: [shares by height](field/shares.csv), [posteriors](field/posterior.csv) and \
[likelihoods](field/likelihood.csv). `field/cases/` has every simulated stack, and `field/studies/` the studies that \
simulate the stacks.
The record of Napa College comes with the program. The records of the other stations may not be distributed with the \
program; without `--records` the command skips the hindcasts of these stations, and lists them.
";

const METHOD: &str = "\
## How observations and model are compared

**Stacks.** The stacks are those of `demo-napa`: the rack `two-barrel`, two full Bordeaux barrels side by side, one \
rack deep, two to six levels, each stack alone on an open floor.
In the simulations in the planes across and along the barrels, one horizontal component and the vertical component \
act. In the three-dimensional simulations (“in space” in the tables), all three components act. The stack is turned by \
a random angle, because the orientation of the rows is not known.
Fallen barrels are counted 4 s after the first loss of a seat.

**Unknowns.** Each case has its own values of four unknowns, whose logarithms are uniformly distributed: barrel–rack \
friction from 0.12 to 0.75, rack–ground friction from 0.30 to 0.85, stiffness of a seat from 0.7 to 13 MN/m, and a \
factor on the motion from 0.5 to 2.
The prior of the first three unknowns is lognormal, truncated to these ranges. The medians are those of the catalog: \
0.30, 0.50 and 3 MN/m. The standard deviations of the natural logarithms are the defaults of `[unknowns]`: 0.35, 0.20 \
and 0.6, in the same order. The motion in a cellar is assumed to differ from the motion at the station by a factor \
with a median of 1 and a standard deviation of its logarithm of 0.3 (0.4 for Maule).

**Probability of a fall.** In each study, this probability is fitted by a logistic regression of second degree in \
the height and in the logarithms of the four unknowns. For three-dimensional simulations, the regression also \
contains cos 2φ and sin 2φ of the azimuth φ. The coefficients have a weak prior; their uncertainty is represented by \
draws from a Metropolis chain.
If a stack of a given height falls, the share of its barrels that fall is taken as the mean over the simulated \
stacks of this height that fell.
Studies of only 10 to 60 cases (Concord, Waiau, and the three-dimensional study of Curicó) determine the \
coefficients poorly, so the ranges of their results mainly show the uncertainty of the fit.

**Likelihoods.** Let p(h, u, a, φ) be the probability that a stack of height h falls with unknowns u, motion a and \
azimuth φ. Let w(h) be the proportion of the stacks that have the height h; all mixtures of heights are equally \
likely. If a stack of height h falls, d(h) is the mean share of its barrels that fall. Then

```text
S = Σ w(h) p(h, u, a, φ) d(h)                       share of barrels; without d(h), share of stacks
barrels:  L(u) = E exp(−(S − value)² / 2 σ²)         over w, a, φ and the uncertainty of p
most:     L(u) = E Φ((S − value) / σ)
few:      L(u) = E Φ((value − S) / σ)
some:     L(u) = E [1 − (1 − S)^stacks]
```

";

/// Returns the page as Markdown.
pub(super) fn page(observations: &Statements, cases: &[FieldCases], results: &Results) -> String {
    let mut text = HEAD.to_owned();
    in_short(&mut text, cases, results);
    text.push_str("\n## What was observed\n");
    for quake in &observations.earthquake {
        observed(&mut text, quake);
    }
    text.push('\n');
    text.push_str(METHOD);
    let _ = writeln!(
        text,
        "For “half”, σ is 0.077, so that 35 to 65 % is the 95 % interval. A model error of {MODEL_ERROR:.2} is added \
         to every σ in quadrature, because neighboring stacks, walls and empty barrels are not simulated. The \
         posterior without this error is shown for comparison.\nAll results are from {DRAWS} draws of the unknowns. \
         The factor on the motion is the same for both statements on Napa Barrel Care."
    );
    text.push_str(
        "\n## What the model predicts\n\nThe predictions in two columns do not use any observation. “Catalog medians” \
         is the probability of a fall with the medians of the catalog, under the unscaled record. “Prior” is the mean \
         probability of a fall over the prior distribution of the unknowns. The central 90 % interval in parentheses \
         includes the uncertainty of the fit.\nThe column “given half” uses the statement “half” (half of the barrels \
         are on the floor). It gives the mean and the interval over the posterior distribution of the unknowns that \
         follows from this statement.\nFor Napa College, the columns “prior” and “given half” include the uncertain \
         factor by which the motion is multiplied; for the other stations this factor is 1.\nThe column “simulated \
         falls” gives the number of simulated stacks that fall, and the number of simulated stacks. The simulations \
         cover the whole range of the unknowns, which is wider than the prior, so this count must not be compared with \
         the share that fell in a cellar.\nThe table [shares by height](field/shares.csv) also states the mean fitted \
         probability of these cases, for comparison with the count.\n",
    );
    for quake in &observations.earthquake {
        shares(&mut text, quake, results);
    }
    posterior(&mut text, results);
    predictions(&mut text, observations, results);
    direction(&mut text, cases);
    text.push_str(UNEXPLAINED);
    text.push_str(ELSEWHERE);
    text
}

/// Formats a share in percent.
fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn of_share(range: &Range) -> String {
    format!("{:.0} % ({:.0} to {:.0})", 100.0 * range.mean, 100.0 * range.low, 100.0 * range.high)
}

fn of_value(range: &Range) -> String {
    format!("{:.2} ({:.2} to {:.2})", range.median, range.low, range.high)
}

fn observed(text: &mut String, quake: &Earthquake) {
    let _ = write!(
        text,
        "\n### {}\n\n{}\n{}\n\n| observed | source | how it is used, or why it is not used |\n| :--- | :--- | :--- |\n",
        quake.name, quake.about, quake.place
    );
    for one in &quake.observation {
        let read = match (&one.uncertainty, &one.reason) {
            (Some(uncertainty), _) => uncertainty.clone(),
            (None, Some(reason)) => format!("Not used. {reason}"),
            (None, None) => String::new(),
        };
        let _ = writeln!(text, "| {} | {} | {read} |", one.statement, one.source);
    }
}

/// Returns the phrase that describes the simulations of a study: "across" or "along" for simulations in the plane
/// across or along the barrels, "in space" for three-dimensional simulations.
fn view(study: &str) -> &'static str {
    match study.rsplit('-').next() {
        Some("across") => "across",
        Some("along") => "along",
        _ => "in space",
    }
}

fn shares(text: &mut String, quake: &Earthquake, results: &Results) {
    let mut studies: Vec<(&str, String)> =
        quake.studies.iter().map(|study| (study.as_str(), place(study))).collect();
    if quake.studies.iter().any(|study| study == "south-napa-along") {
        for study in ["south-napa-rack-on-rack-across", "south-napa-rack-on-rack-along"] {
            studies.push((study, place(study)));
        }
    }
    if studies.is_empty() {
        return;
    }
    let _ = write!(
        text,
        "\n### {}\n\n| stack | levels | simulated falls | share, 95 % | catalog medians | prior | given half |\n\
         | :--- | ---: | ---: | :--- | ---: | :--- | :--- |\n",
        quake.name
    );
    for (study, place) in studies {
        for one in results.shares.iter().filter(|one| one.study == study) {
            let (falls, cases) = one.count;
            let _ = writeln!(
                text,
                "| {} | {} | {falls} of {cases} | {:.0} to {:.0} % | {} | {} | {} |",
                if one.levels == 2 { place.as_str() } else { "" },
                one.levels,
                100.0 * one.design.low,
                100.0 * one.design.high,
                percent(one.medians),
                of_share(&one.prior),
                of_share(&one.posterior),
            );
        }
    }
}

fn place(study: &str) -> String {
    let view = view(study);
    let station =
        [("curico", "Curicó, "), ("hualane", "Hualañé, "), ("rack-on-rack", "racks on posts, ")]
            .into_iter()
            .find(|(name, _)| study.contains(name))
            .map_or("", |(_, station)| station);
    format!("{station}{view}")
}

fn posterior(text: &mut String, results: &Results) {
    text.push_str(
        "\n## Friction and stiffness given the observations\n\nEach cell gives the median and the central 90 % \
         interval. The first row is the prior, without any observation.\n\n| given | friction barrel–rack | friction \
         rack–ground | stiffness of a seat (MN/m) | factor on the motion | effective draws |\n| :--- | :--- | :--- | \
         :--- | :--- | ---: |\n",
    );
    for one in &results.posteriors {
        let cells = one.unknowns.each_ref().map(of_value);
        let given = match one.given.as_str() {
            "prior" => "nothing (prior)".to_owned(),
            "all statements" => "all of them".to_owned(),
            other => format!("“{other}”"),
        };
        let _ = writeln!(text, "| {given} | {} | {:.0} |", cells.join(" | "), one.effective);
    }
    text.push_str("\nThe column “factor on the motion” gives the factor by which the motion is multiplied. In the row \
                   “maule”, this is the motion at Curicó.\nThe effective number of draws is (Σ L)² / Σ L²; if the \
                   likelihood L were the same for all draws, this number would equal the total number of draws.\n\n\
                   ![Share of barrels on the floor against friction, and friction before and after the \
                   observations](field.svg)\n\nEach of the next tables gives the likelihood of each statement for \
                   several ranges of one unknown, averaged over all other unknowns (the largest possible \
                   likelihood is 1):\n\n");
    let edges: [(usize, &str, &[f64]); 3] = [
        (0, "friction barrel–rack", &FRICTION),
        (1, "friction rack–ground", &GROUND),
        (2, "stiffness (MN/m)", &STIFFNESS),
    ];
    for (unknown, name, edges) in edges {
        let header: Vec<String> =
            edges.windows(2).map(|edge| format!("{} to {}", edge[0], edge[1])).collect();
        let _ = writeln!(text, "| {name} | {} |", header.join(" | "));
        let _ = writeln!(text, "| :--- |{}", " ---: |".repeat(header.len()));
        let mut given: Vec<&str> = results.bins.iter().map(|bin| bin.given.as_str()).collect();
        given.dedup();
        for one in given {
            let cell = |edge: &[f64]| {
                let is = |bin: &&Bin| {
                    bin.given == one && bin.unknown == unknown && bin.range == [edge[0], edge[1]]
                };
                let found = results.bins.iter().find(is);
                found.map_or_else(|| "–".to_owned(), |bin| format!("{:.2}", bin.likelihood))
            };
            let cells: Vec<String> = edges.windows(2).map(cell).collect();
            let _ = writeln!(text, "| “{one}” | {} |", cells.join(" | "));
        }
        text.push('\n');
    }
}

fn predictions(text: &mut String, observations: &Statements, results: &Results) {
    text.push_str("## Each statement compared with the model\n\n| statement | observed | model, prior | model, given half | mean likelihood |\n| :--- | :--- | :--- | :--- | ---: |\n");
    for (id, prior, posterior) in &results.predictions {
        let Some((_, one)) = observations.find(id) else { continue };
        let likelihood = results.given(id).map_or(f64::NAN, |one| one.evidence);
        let _ = writeln!(
            text,
            "| “{id}”: share of {} | {} | {} | {} | {likelihood:.2} |",
            one.subject(),
            one.bound(),
            of_share(prior),
            of_share(posterior),
        );
    }
}

/// Returns two counts for a three-dimensional study: the falls in which the first body left its seat along the barrels,
/// and all falls.
fn along(cases: &[FieldCases], study: &str) -> (u32, u32) {
    let all = cases.iter().filter(|one| one.study == study).flat_map(|one| &one.cases);
    all.filter(|case| case.falls).fold((0, 0), |(along, all), case| {
        (along + u32::from(matches!(case.heading.as_str(), "away" | "near")), all + 1)
    })
}

fn direction(text: &mut String, cases: &[FieldCases]) {
    text.push_str("\n## Direction\n\nThe table is for the three-dimensional simulations, in which the stacks are \
                   turned by random angles. Of all stacks that fall, the table counts those in which the first body \
                   that leaves its seat does so in the direction along the barrels:\n\n| station | along the barrels | \
                   share, 95 % | first mode (cases) |\n| :--- | ---: | :--- | :--- |\n");
    for (study, name) in
        [("south-napa-space", "Napa College"), ("curico-space", "Curicó"), ("waiau-space", "Waiau")]
    {
        let (along, all) = along(cases, study);
        let interval = wilson(along, all, 0.95);
        let mut modes = std::collections::BTreeMap::<&str, u32>::new();
        for case in cases.iter().filter(|one| one.study == study).flat_map(|one| &one.cases) {
            if case.falls {
                *modes.entry(&case.mode).or_default() += 1;
            }
        }
        let modes: Vec<String> =
            modes.iter().map(|(mode, count)| format!("{mode} {count}")).collect();
        let _ = writeln!(
            text,
            "| {name} | {along} of {all} | {:.0} to {:.0} % | {} |",
            100.0 * interval.low,
            100.0 * interval.high,
            modes.join(", ")
        );
    }
    text.push_str("\nThe statement “Racks slid off the ends of the barrels below” names this direction, and most \
                   stacks of the model fall in this direction. Since nobody counted the racks that slid off, no \
                   likelihood is given.\nThe collapse mode agrees less well. At Napa College, the first body that \
                   leaves its seat in the model is more often a barrel (“ejection”) than a rack; no report mentions \
                   this. However, a barrel on a leaning rack counts as fallen once it is low enough, so the \
                   distinction between the two modes is a convention (see [space.md](space.md)).\n");
}

fn share<'a>(results: &'a Results, study: &str, levels: usize) -> Option<&'a Share> {
    results.shares.iter().find(|one| one.study == study && one.levels == levels)
}

fn mean(results: &Results, study: &str, levels: usize) -> String {
    share(results, study, levels).map_or_else(String::new, |one| percent(one.prior.mean))
}

fn unknown(one: Option<&Posterior>, at: usize) -> String {
    one.map_or_else(String::new, |one| of_value(&one.unknowns[at]))
}

fn in_short(text: &mut String, cases: &[FieldCases], results: &Results) {
    let range = |id: &str| results.prediction(id);
    text.push_str("\n## In short\n\n");
    if let Some((prior, posterior)) = range("half") {
        let _ = writeln!(
            text,
            "- **South Napa.** Half of 18,000 barrels were on the floor. Without any observation, the model predicts \
             {} of the barrels on the floor. If the model is conditioned on this observation (the statement “half”), \
             it predicts {}. Here and below, the numbers in parentheses are the central 90 % interval over the \
             unknowns.",
            of_share(prior),
            of_share(posterior)
        );
    }
    let _ = writeln!(
        text,
        "- **Friction of barrels on racks.** The median is {} without any observation. It is {} given only the \
         statement “half” (half of the barrels were on the floor), and {} given all statements. The observations \
         hardly change it, so the default of the catalog, 0.30, is kept; the value of Candia et al. (2008), 0.22, lies \
         within all three ranges.",
        unknown(results.given("prior"), 0),
        unknown(results.given("half"), 0),
        unknown(results.given("all statements"), 0),
    );
    let _ = writeln!(
        text,
        "- **Stiffness of a seat.** The median is {} MN/m without any observation. It is {} MN/m given only the \
             statement “half”, and {} MN/m given all statements.",
        unknown(results.given("prior"), 2),
        unknown(results.given("half"), 2),
        unknown(results.given("all statements"), 2),
    );
    if let Some((prior, posterior)) = range("room") {
        let _ = writeln!(
            text,
            "- **The smaller room.** Almost every stack in the smaller room of Napa Barrel Care fell. Without any \
             observation, the model predicts that {} of these stacks fall. Given the statement “half” (half of all \
             barrels were on the floor), it predicts {}. The observation is possible if the stacks of this room were \
             higher than the others, or at another angle to the motion; no report says whether they were.",
            of_share(prior),
            of_share(posterior)
        );
    }
    if let Some((prior, _)) = range("posts") {
        let _ = writeln!(
            text,
            "- **Racks on posts.** According to the reports, stacks whose racks stand on posts on the rack below lost \
             next to nothing. The model, with a rack that was not tuned to this observation, predicts that {} of such \
             stacks fall.",
            of_share(prior)
        );
    }
    if let (Some(before), Some(after)) = (results.given("prior"), results.given("half")) {
        let _ = writeln!(
            text,
            "- **What follows from the fall of half of the barrels.** This observation hardly changes the \
             distributions of the unknowns. The median of the factor on the motion changes from {} to {}. The mean \
             likelihood of the observation is {} for a barrel–rack friction between 0.12 and 0.18, and {} for a \
             friction between 0.25 and 0.35.",
            of_value(&before.unknowns[3]),
            of_value(&after.unknowns[3]),
            likelihood(results, "half", 0.12),
            likelihood(results, "half", 0.25),
        );
    }
    let (along, all) = along(cases, "south-napa-space");
    let _ = writeln!(
        text,
        "- **Direction.** In {along} of {all} falls in three-dimensional simulations, the first body leaves its seat \
         along the barrels. This is the direction that the reports name.\n- **Maule.** Averaged over the prior, {} of \
         stacks of four levels fall along the barrels at Curicó and {} at Hualañé. The model thus agrees with the \
         reports that barrels fell. However, it predicts that nearly all stacks of four levels fell, and no report \
         says so.\n- **Kaikōura.** No cellar experienced the motion that was recorded. Under this motion, {} of stacks \
         of four levels fall in three-dimensional simulations.\n- **Far away.** {}",
        mean(results, "curico-along", 4),
        mean(results, "hualane-along", 4),
        mean(results, "waiau-space", 4),
        far(cases),
    );
}

/// Formats the mean likelihood of a statement if the barrel–rack friction lies in the bin whose lower edge is `from`.
/// Returns an empty string if there is no likelihood for this bin.
fn likelihood(results: &Results, given: &str, from: f64) -> String {
    let is = |bin: &&Bin| bin.given == given && bin.unknown == 0 && bin.range[0] == from;
    results.bins.iter().find(is).map_or_else(String::new, |bin| format!("{:.2}", bin.likelihood))
}

/// Describes the stacks that fall at the distant station (Concord).
fn far(cases: &[FieldCases]) -> String {
    let all: Vec<_> = cases
        .iter()
        .filter(|one| one.study.starts_with("concord"))
        .flat_map(|one| &one.cases)
        .collect();
    let fallen: Vec<String> = all
        .iter()
        .filter(|case| case.falls)
        .map(|case| {
            let [friction, _, stiffness, factor] = case.unknowns;
            format!(
                "{} levels with a barrel–rack friction of {friction:.2} and seats of {stiffness:.2} MN/m, under \
                 {factor:.1} times the record",
                case.levels
            )
        })
        .collect();
    let count = all.len();
    if fallen.is_empty() {
        return format!("At Concord, with 0.03 g, none of {count} stacks falls.");
    }
    format!(
        "At Concord, with 0.03 g, a stack falls in {} of {count} cases: {}. Such a stack would not stand for long in \
         everyday use, so this combination of unknowns can be ruled out.",
        fallen.len(),
        fallen.join("; ")
    )
}

const UNEXPLAINED: &str = "
## What remains unexplained

- **Friction and stiffness.** In the model, most stacks of four to six levels fall for nearly every value of the \
friction coefficient. At least the bottom level of a fallen stack remains standing. Therefore, about half of the \
barrels are on the floor, almost regardless of the values of the constants. Counts of fallen stacks of two and three \
levels would narrow the ranges of the constants, because the friction decides whether such stacks fall. Nobody has \
published such counts.
- **Why half fell and half did not.** In the model this depends on the motion in the cellar and on the direction of \
the rows, neither of which is known. The heights of the stacks in each room, the direction of the rows and a record \
inside the building would explain more than any test of friction.
- **The smaller room and the rest of the cellar.** One set of constants explains both only if the stacks in the \
smaller room differed from the other stacks in height or in orientation. Stacks that knock other stacks over would \
also explain both, but such impacts are not simulated: each stack stands alone on an open floor, without neighbors, \
walls or aisles. The model error of 0.10, which is meant to allow for this, is a guess.
- **Empty barrels.** Many barrels were empty in August 2014 (Press Democrat 2014, above). In the model all are full.
- **Long motions.** Under both records of Maule, racks walk until they fall off, and the first loss of a seat occurs \
after 30 to 50 s. If the stacks in Chile had been of the simulated kind, nearly all stacks near Curicó would have \
fallen. No report says that they did. It is not known which racks were used there, or how high they were stacked. \
Walking over many cycles is the part of the model with the least evidence ([rack-walk.md](rack-walk.md)).
- **Height.** In the model, the share of stacks that fall grows from two to five levels, but not beyond. Whether \
stacks of six levels fell more often than stacks of four has not been published.
- **Posts.** Racks on posts stand in the model as they did in the earthquake, but no number supports the words “next \
to nothing”, and the posts of the model are an assumption.

The statements are so vague that they can contradict the model only if its errors are large. They do not contradict \
the model, and nothing more can be concluded.
";

const ELSEWHERE: &str = "\n## Earthquakes and records without a hindcast

| record or earthquake | nearest wine country | why there is no hindcast |
| :--- | :--- | :--- |
| San Simeon 2003 | Paso Robles | close to 20 wineries lost stacks, but no record is at hand |
| Yountville 2000 | Napa | accelerations are published, but neither a record nor what happened to stacks |
| Seddon 2013 | Marlborough | no record at hand, no statement on barrels |
| Maule 2010, Santiago Centro | Maipo, 15 to 30 km | a city; no statement on barrels there, and the drift of its \
record needs more than the usual filter |
| South Napa 2014, BK.CMB (Columbia) | Sierra foothills | 0.0005 g, 150 km away |
| Virginia 2011, Reston (0.04 g, one component) | Loudoun, 30 km | no statement on barrels |
| Northridge, El Centro, Chi-Chi, Kobe, Ridgecrest, Anchorage | none within 50 km | no barrels |
";
