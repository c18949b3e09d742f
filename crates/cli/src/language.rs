//! Option `--language`: the language of pages and reports.

use barrelstack_report::{Document, Language};

use crate::typed::typed;

/// Option of all commands that write a page or a report.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct LanguageArgs {
    /// Language of the page or report; numbers, units and the text on the terminal are not affected.
    #[arg(long, value_enum, value_name = "LANGUAGE", default_value = "en")]
    language: LanguageName,
}

typed! {
    /// The languages, by their codes on the command line.
    enum LanguageName of Language {
        /// English.
        En = Self::English,
        /// Spanish.
        Es = Self::Spanish,
    }
}

impl LanguageArgs {
    /// Returns the selected language.
    pub(crate) fn of(self) -> Language {
        self.language.into()
    }

    /// Translates a document to the selected language.
    pub(crate) fn page(self, document: &Document) -> Document {
        document.in_language(self.of())
    }
}
