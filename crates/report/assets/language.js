// Texts in the language of the page.

// Entries by their English text; English needs none.
const entries = JSON.parse(document.getElementById("language")?.textContent || "{}");

// Returns a text in the language of the page, with values in the places of {1}, {2} and so on.
const t = (english, ...values) =>
  (entries[english] ?? english).replace(/\{(\d)\}/g, (_, place) => values[place - 1]);
