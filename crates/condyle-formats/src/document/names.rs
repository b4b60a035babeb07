//! Documents of kind `names`: what the labels of recordings are called in models.
//!
//! ```text
//! document  = the head of every document, and
//! names     = LABEL = "MARKER", or a list of markers: the first that a model has
//! ```

use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Read};

const FORM: Form = Form { kind: Kind::Names, keys: &["names"], own: &[], repeated: &[] };

/// For each label of a recording what it may be called in a model, the likeliest first.
pub type NameTable = Vec<(String, Vec<String>)>;

/// Reads a table of names. `include` gives the text of another one by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::names;
/// let text = r#"
/// condyle = 1
/// kind = "names"
/// [names]
/// RKNE = ["R.Knee", "r_knee"]
/// SACR = "V.Sacral"
/// "#;
/// let table = names::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(table[1], ("SACR".to_owned(), vec!["V.Sacral".to_owned()]));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<NameTable>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| {
        let node = top.get("names");
        let mut table = vec![];
        for entry in node.map_or(&[][..], |node| reader.entries(node, "names")) {
            let (names, _) = reader.names(&entry.node, &entry.key.text);
            table.push((entry.key.text.clone(), names.into_iter().map(|n| n.text).collect()));
        }
        Some(table)
    })
}
