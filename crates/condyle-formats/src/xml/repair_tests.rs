use super::*;

fn repaired(text: &str) -> (String, Vec<&'static str>) {
    let mut warnings = Warnings::default();
    let text = repair(text, &mut warnings).unwrap().into_owned();
    (text, warnings.finish().iter().map(|w| w.code).collect())
}

#[test]
fn undeclared_prefixes_lose_their_colon() {
    let (text, codes) = repaired("<a><H::P x:y=\"u:v\">t:t<!--c:d--></H::P></a>");
    assert_eq!(text, "<a><H__P x_y=\"u:v\">t:t<!--c:d--></H__P></a>");
    assert_eq!(codes, ["xml/prefix"]);
}

#[test]
fn bare_ampersands_and_less_signs_are_no_markup() {
    let (text, codes) = repaired("<a n=\"R&D\">x & y &amp; &nbsp; &#0; &#xe9; p < 5 <1</a>");
    assert_eq!(
        text,
        "<a n=\"R\u{7f}D\">x \u{7f} y &amp; \u{7f}nbsp; \u{7f}#0; &#xe9; p   5  1</a>"
    );
    assert_eq!(codes, ["xml/ampersand", "xml/less", "xml/less"]);
    assert_eq!(repaired("<a n='x<y'/>").0, "<a n='x y'/>");
    let untouched = "<a><!-- & < --><![CDATA[& <]]></a>";
    assert_eq!(repaired(untouched), (untouched.to_owned(), vec![]));
}

#[test]
fn control_characters_become_spaces() {
    let (text, codes) = repaired("<a>\u{1}b\u{ffff}</a>\0\0\x1a");
    assert_eq!(text.trim_end(), "<a> b   </a>");
    assert_eq!(codes, ["xml/control"]);
}

#[test]
fn what_follows_the_end_is_skipped() {
    for junk in ["<x/>", "junk", "<x>", "<a/><!-- -->", " & <x a='&'/>", "<"] {
        let (text, codes) = repaired(&format!("<a><b/></a>\n<!-- c -->\n{junk}"));
        assert_eq!(text.trim_end(), "<a><b/></a>\n<!-- c -->", "{junk}");
        assert_eq!(codes, ["xml/after-end"], "{junk}");
    }
    let fine = "<a/>\n<!-- c --><?p q?>\n";
    assert_eq!(repaired(fine), (fine.to_owned(), vec![]));
}

#[test]
fn a_declaration_after_a_comment_is_skipped() {
    let (text, codes) = repaired("<!-- c --><?xml version='1.0'?><a/>");
    assert_eq!(text.replace(' ', ""), "<!--c--><a/>");
    assert_eq!(codes, ["xml/before-declaration"]);
}

#[test]
fn declared_prefixes_stay_while_in_scope() {
    let text = "<r><p:a xmlns:p=\"u\" p:b=\"1\"><p:c/></p:a><p:d/><e xml:id=\"i\"/></r>";
    let (repaired, codes) = repaired(text);
    assert_eq!(repaired, text.replace("<p:d/>", "<p_d/>"));
    assert_eq!(codes, ["xml/prefix"]);
}

#[test]
fn bytes_before_the_declaration_become_spaces() {
    let (text, codes) = repaired("\n é <?xml version=\"1.0\"?>\n<a/>");
    assert_eq!(text.trim(), "<a/>");
    assert_eq!(text.len(), "\n é <?xml version=\"1.0\"?>\n<a/>".len());
    assert_eq!(text.lines().count(), 3);
    assert_eq!(codes, ["xml/before-declaration"]);
}

#[test]
fn untidy_comments_are_skipped() {
    let (text, codes) = repaired("<a><!-- x -- y\n --><b/><!-- x ---></a>");
    assert_eq!(text.replace(' ', ""), "<a>\n<b/></a>");
    assert_eq!(codes, ["xml/comment"; 2]);
}

#[test]
fn closing_tags_that_close_nothing_are_skipped() {
    let (text, codes) = repaired("<a><b/></a>\n</OpenSimDocument >\n");
    assert_eq!(text.trim_end(), "<a><b/></a>");
    assert_eq!(codes, ["xml/stray-end"]);
}

#[test]
fn cdata_and_instructions_are_not_markup() {
    let text = "<a><![CDATA[<x:y>]]><?p <q:r?></a>";
    assert_eq!(repaired(text), (text.to_owned(), vec![]));
}

#[test]
fn depth_is_bounded() {
    let mut warnings = Warnings::default();
    let fine = "<a>".repeat(MAX_DEPTH) + &"</a>".repeat(MAX_DEPTH);
    assert!(repair(&fine, &mut warnings).is_ok());
    let deep = "<a>".repeat(MAX_DEPTH + 1);
    let error = repair(&deep, &mut warnings).unwrap_err();
    assert_eq!(error.code(), "xml/depth");
    assert_eq!(error.place().unwrap().column, 3 * MAX_DEPTH + 1);
}
