//! Players as markup: stages, controls, printed pictures and the list of events.

use crate::{
    Event, FigureKind, Pane, Player, Players,
    document::opening,
    escape,
    html::{Writer, sign},
    number, player_data,
};

/// Number of events that are shown while the list is collapsed.
const OPEN_EVENTS: usize = 4;

/// Maximum length (bytes) of a verdict that is shown whole above its pane. Of a longer verdict, only the opening is
/// shown there; the remaining sentences follow below the player.
const PANE_VERDICT: usize = 120;

/// Markup of the controls, with a placeholder for the drawings of the scenes.
const CONTROLS: &str = include_str!("../assets/player.html");

/// Markup of the container for the drawing of one scene.
const STAGE: &str = include_str!("../assets/stage.html");

impl Writer<'_> {
    pub(crate) fn player(&mut self, player: &Player) {
        let id = self.names.take(&player.id);
        let place = self.payload.players.len();
        self.payload.players.push(player_data::of_player(player, &id));
        self.put(&format!(
            "<figure class=\"player\" id=\"figure-{id}\" data-player=\"{place}\">\n"
        ));
        let controls = self.markup(CONTROLS).replace("{stages}", &self.markup(STAGE));
        self.put(&controls);
        if self.prints {
            self.put("<div class=\"paper\">\n");
            if let FigureKind::Strip(strip) = player.paper_figure(&self.document.blocks).kind {
                self.strip(&strip, &id);
            }
            self.put("</div>\n");
        }
        self.caption(&player.caption);
        self.events(player.scene.events.iter().map(|event| ("", event)).collect());
        self.put("</figure>\n");
    }

    pub(crate) fn players(&mut self, players: &Players) {
        let id = self.names.take(&players.id);
        let place = self.payload.players.len();
        self.payload.players.push(player_data::of_players(players, &id));
        self.put(&format!(
            "<figure class=\"player several\" id=\"figure-{id}\" data-player=\"{place}\">\n"
        ));
        let one = self.markup(STAGE);
        let stage =
            |pane: &Pane| format!("<section class=\"pane\">\n{}{one}</section>\n", pane_head(pane));
        let stages: String = players.panes.iter().map(stage).collect();
        let stages = format!("<div class=\"panes\">\n{stages}</div>\n");
        let controls = self.markup(CONTROLS).replace("{stages}", &stages);
        self.put(&controls);
        if self.prints {
            self.put("<div class=\"paper\">\n");
            for (pane, figure) in players.panes.iter().zip(players.paper_figures()) {
                self.put(&pane_head(pane));
                let name = self.names.take(&figure.id);
                if let FigureKind::Strip(strip) = figure.kind {
                    self.strip(&strip, &name);
                }
            }
            self.put("</div>\n");
        }
        self.caption(&players.caption);
        let mut events: Vec<(&str, &Event)> = players
            .panes
            .iter()
            .flat_map(|pane| pane.scene.events.iter().map(|event| (pane.mark.as_str(), event)))
            .collect();
        events.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
        self.events(events);
        self.put("</figure>\n");
        for pane in &players.panes {
            let (_, rest) = opening(&pane.verdict, PANE_VERDICT);
            if !rest.is_empty() {
                let mark = escape::html(&pane.mark);
                let open = format!("<p class=\"text\"><b class=\"mark\">{mark}</b> ");
                self.explained(&open, rest, "</p>");
            }
        }
    }

    fn markup(&self, english: &str) -> String {
        self.document.language.markup(english)
    }

    /// Writes the list of events. Each event is paired with the mark of its pane, which is empty if there is only one
    /// pane.
    fn events(&mut self, mut events: Vec<(&str, &Event)>) {
        events.retain(|(_, event)| event.time.is_finite());
        if events.is_empty() {
            return;
        }
        // Folding a single line would save no space.
        let open = if events.len() > OPEN_EVENTS + 1 { OPEN_EVENTS } else { events.len() };
        let (first, rest) = events.split_at(open);
        self.event_list(first);
        if !rest.is_empty() {
            let more = self.document.language.text(&format!("{} more events", rest.len()));
            self.put(&format!("<details class=\"more\">\n<summary>{more}</summary>\n"));
            self.event_list(rest);
            self.put("</details>\n");
        }
    }

    fn event_list(&mut self, events: &[(&str, &Event)]) {
        let label = self.t("Events");
        self.put(&format!("<ol class=\"events\" aria-label=\"{label}\">\n"));
        for (pane, event) in events {
            self.put(&format!(
                "<li><button type=\"button\" data-time=\"{}\"><i class=\"event {}\" aria-hidden=\"true\"></i><span class=\"when\">{}\u{a0}s</span><span class=\"what\">{}</span>",
                event.time,
                event.kind.class(),
                number::fixed(event.time, 2),
                escape::html(event.kind.word_in(self.document.language))
            ));
            self.put("<span class=\"text\">");
            if !pane.is_empty() {
                self.put(&format!("<b class=\"mark\">{}</b> ", escape::html(pane)));
            }
            self.element("", &event.text, "</span></button></li>");
        }
        self.put("</ol>\n");
    }
}

/// Returns the markup of the line above a pane, which states the name and the verdict of the pane.
fn pane_head(pane: &Pane) -> String {
    format!(
        "<div class=\"pane-head {}\">{}<p><b><span class=\"mark\">{}</span> {}</b> <span>{}</span></p></div>\n",
        pane.tone.class(),
        sign(pane.tone),
        escape::html(&pane.mark),
        escape::html(&number::tied(&pane.name)),
        escape::html(&number::tied(opening(&pane.verdict, PANE_VERDICT).0))
    )
}
