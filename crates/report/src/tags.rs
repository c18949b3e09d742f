//! Logical structure of a PDF: headings, table cells and figures.

use pdf_writer::{
    Finish as _, Pdf, Ref, TextStr,
    types::{StructRole, TableHeaderScope},
};

/// Structure elements in reading order; the first is the document.
pub(crate) struct Tags {
    elements: Vec<Element>,
}

struct Element {
    role: StructRole,
    parent: usize,
    /// Text alternative of a figure.
    words: Option<String>,
    kids: Vec<Kid>,
}

/// Child of an element.
enum Kid {
    /// Another element.
    Element(usize),
    /// Content of the page at index `page`, with the marked-content identifier `number`.
    Painted { page: usize, number: i32 },
}

impl Tags {
    pub(crate) fn new() -> Self {
        let document =
            Element { role: StructRole::Document, parent: 0, words: None, kids: Vec::new() };
        Self { elements: vec![document] }
    }

    /// Appends a new element to its parent and returns the index of the new element.
    pub(crate) fn open(&mut self, parent: usize, role: StructRole, words: Option<&str>) -> usize {
        let place = self.elements.len();
        let words = words.map(str::to_owned);
        self.elements.push(Element { role, parent, words, kids: Vec::new() });
        self.elements[parent].kids.push(Kid::Element(place));
        place
    }

    pub(crate) fn role(&self, place: usize) -> StructRole {
        self.elements[place].role
    }

    /// Adds content of a page to the element at index `place`; `number` is its marked-content identifier.
    pub(crate) fn paint(&mut self, place: usize, page: usize, number: i32) {
        self.elements[place].kids.push(Kid::Painted { page, number });
    }

    /// Writes the structure tree.
    ///
    /// `pages` are the pages of the document, and `next` allocates references. For each page, `painted` lists the
    /// indices of the elements that own its marked content, in the order of the marked-content identifiers.
    pub(crate) fn write(
        &self,
        pdf: &mut Pdf,
        root: Ref,
        pages: &[Ref],
        painted: &[Vec<usize>],
        next: &mut dyn FnMut() -> Ref,
    ) {
        let ids: Vec<Ref> = self.elements.iter().map(|_| next()).collect();
        let lists: Vec<Ref> = painted.iter().map(|_| next()).collect();
        let mut tree = pdf.indirect(root).start::<pdf_writer::writers::StructTreeRoot<'_>>();
        tree.child(ids[0]);
        let mut parents = tree.parent_tree();
        let mut entries = parents.nums();
        for (page, list) in lists.iter().enumerate() {
            entries.insert(i32::try_from(page).unwrap_or(i32::MAX), *list);
        }
        entries.finish();
        parents.finish();
        tree.parent_tree_next_key(i32::try_from(pages.len()).unwrap_or(i32::MAX));
        tree.finish();
        for (list, elements) in lists.iter().zip(painted) {
            pdf.indirect(*list).array().items(elements.iter().map(|place| ids[*place]));
        }
        for (element, id) in self.elements.iter().zip(&ids) {
            let mut written = pdf.struct_element(*id);
            written.kind(element.role);
            let document = element.role == StructRole::Document;
            written.parent(if document { root } else { ids[element.parent] });
            if let Some(words) = &element.words {
                written.alt(TextStr(words));
            }
            if element.role == StructRole::TH {
                written.attributes().push().table().scope(TableHeaderScope::Column);
            }
            let mut children = written.children();
            for kid in &element.kids {
                match kid {
                    Kid::Element(place) => {
                        children.struct_element(ids[*place]);
                    }
                    Kid::Painted { page, number } => {
                        children.marked_content_ref().page(pages[*page]).marked_content_id(*number);
                    }
                }
            }
        }
    }
}
