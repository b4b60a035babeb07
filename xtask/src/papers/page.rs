//! The page of all items.

use super::{Item, Made};

/// HTML that grows item by item.
pub(super) struct Page {
    text: String,
}

const HEAD: &str = "<!doctype html>
<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">
<title>The figures of the papers</title>
<style>
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
pre { overflow-x: auto; padding: 0.6rem; border: 1px solid #8886; border-radius: 4px; font-size: 0.85rem; }
img { max-width: 100%; background: #fff; }
h3 { margin-top: 2.5rem; }
</style>
<h1>The figures and tables of the papers</h1>
<p>Each with the command that makes it, what comes out here, and what the paper prints.</p>
";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

impl Page {
    pub(super) fn new() -> Self {
        Self { text: HEAD.to_owned() }
    }

    pub(super) fn paper(&mut self, title: &str) {
        self.text.push_str(&format!("<h2>{}</h2>\n", escaped(title)));
    }

    fn head(&mut self, item: &Item) {
        let (name, shows) = (escaped(item.name), escaped(item.shows));
        self.text.push_str(&format!("<h3>{name}</h3>\n<p>{shows}</p>\n"));
    }

    pub(super) fn item(&mut self, item: &Item, parts: &[(String, Made)]) {
        self.head(item);
        for (command, made) in parts {
            if !command.is_empty() {
                self.text.push_str(&format!("<pre>{}</pre>\n", escaped(command)));
            }
            match made {
                Made::Text(said) => {
                    self.text.push_str(&format!("<pre><samp>{}</samp></pre>\n", escaped(said)));
                }
                Made::Picture(name) => {
                    let alt = escaped(item.shows);
                    self.text.push_str(&format!("<img src=\"{name}\" alt=\"{alt}\">\n"));
                }
                Made::Nothing => {}
            }
        }
        self.text.push_str(&format!("<p>{}</p>\n", escaped(item.beside)));
    }

    pub(super) fn missing(&mut self, item: &Item) {
        self.head(item);
        self.text.push_str("<p>Not made: it needs recordings in ../shared/data.</p>\n");
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }
}
