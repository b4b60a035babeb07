//! The page as one file that needs nothing else.

use crate::base64::base64;
use crate::bundle::{CORE, PAGE, PROGRAM, READERS, asset};
use crate::session::{Mode, Session};

/// The page with a session, its program and the evaluator inside: one HTML file that opens without a server
/// and asks for nothing from anywhere. With `all_formats` the readers of all formats are inside as well, for files that are
/// dropped on it: 0.9 MB more.
#[must_use]
pub fn exported(session: &Session, all_formats: bool) -> String {
    let given = session.to_json(Mode::Exported);
    let file = |name| asset(name).map_or(&[][..], |asset| asset.bytes);
    let program = String::from_utf8_lossy(file(PROGRAM));
    let readers = match all_formats {
        true => {
            let readers = base64(file(READERS));
            format!("<script type=\"text/plain\" id=\"readers\">{readers}</script>\n")
        }
        false => String::new(),
    };
    let inside = format!(
        "<script type=\"application/json\" id=\"session\">{}</script>\n\
         <script type=\"text/plain\" id=\"core\">{}</script>\n\
         {readers}<script type=\"module\">{}</script>",
        within_script(&given),
        base64(file(CORE)),
        // In a program these words stand in texts alone, where a backslash changes nothing.
        program.replace("</script", "<\\/script").replace("<!--", "<\\!--"),
    );
    let outside = format!("<script type=\"module\" src=\"assets/{PROGRAM}\"></script>");
    // Not `replace` with the text as a pattern of anything: it stands once.
    match PAGE.split_once(&outside) {
        Some((before, after)) => [before, &inside, after].concat(),
        None => [PAGE, &inside].concat(),
    }
}

/// JSON that no browser takes for the end of its element.
fn within_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_does_not_end_the_script() {
        let mut session = Session::open("knee".as_ref(), &[], &[]).expect("it is shipped").value;
        session.title = "</script><script>alert(1)</script>".to_owned();
        let html = exported(&session, false);
        assert!(!html.contains("alert(1)</script>"), "the title is escaped");
        assert!(!html.contains("src=\"assets/"), "nothing is outside");
        assert_eq!(html.matches("id=\"session\"").count(), 1);
        assert_eq!(html.matches("id=\"readers\"").count(), 0);
        assert_eq!(exported(&session, true).matches("id=\"readers\"").count(), 1);
    }
}
