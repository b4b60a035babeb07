//! The figures and tables of the four papers that the project builds on, made anew by its own commands, in one page
//! beside what the papers print.
//!
//! `cargo xtask papers [FOLDER]` builds the release command, runs what each item lists and writes `index.html` and the
//! pictures to the folder (`target/papers` if none is given). What needs recordings that are not in the project takes them from
//! `../shared/data` and is skipped, saying so, where they are not there.

mod graph;
mod herda2003;
mod page;
mod pronost2010;
mod rotenberg;
mod shao2003;

use crate::cargo;
use crate::outcome::Context;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// One figure, plate or table.
struct Item {
    /// What the paper calls it.
    name: &'static str,
    /// What it shows.
    shows: &'static str,
    /// How it is made.
    steps: &'static [Step],
    /// What the paper prints beside what comes out here, and why they differ.
    beside: &'static str,
}

/// One step on the way to an item.
enum Step {
    /// A text to a file.
    File(&'static str, &'static str),
    /// The command with arguments; `OUT/` is the folder, `DATA/` that of the recordings. What it prints is shown, at most so many lines.
    Run(&'static [&'static str], usize),
    /// Cargo, likewise.
    Cargo(&'static [&'static str], usize),
    /// The components of one joint set of a model as a graph, to a file.
    Graph(&'static str, &'static str, &'static str),
    /// A picture in the folder is shown.
    Picture(&'static str),
    /// A picture of the manual is shown.
    Manual(&'static str),
}

/// A paper.
struct Paper {
    /// A short name for files.
    key: &'static str,
    /// Authors, title, journal.
    title: &'static str,
    items: &'static [Item],
}

const PAPERS: [Paper; 4] = [
    Paper {
        key: "shao2003",
        title: "Shao & Ng-Thow-Hing 2003, A general joint component framework for realistic articulation in human characters",
        items: shao2003::ITEMS,
    },
    Paper {
        key: "herda2003",
        title: "Herda, Urtasun, Fua & Hanson 2003, Automatic determination of shoulder joint limits using quaternion field boundaries",
        items: herda2003::ITEMS,
    },
    Paper {
        key: "pronost2010",
        title: "Pronost, Sandholm & Thalmann 2010, Correlative joint definition for motion analysis and animation",
        items: pronost2010::ITEMS,
    },
    Paper {
        key: "rotenberg",
        title: "Rotenberg, Skeletons (a chapter on character animation)",
        items: rotenberg::ITEMS,
    },
];

/// What came of a step.
enum Made {
    Text(String),
    Picture(String),
    Nothing,
}

/// Makes all items whose paper or name begins with `only`, if it is given.
pub(crate) fn run(
    context: &Context,
    folder: Option<&str>,
    only: Option<&str>,
) -> Result<(), String> {
    let out = folder.map_or_else(|| context.root.join("target/papers"), PathBuf::from);
    std::fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    cargo::run(context, &["build", "--release", "--quiet", "-p", "condyle-cli"])?;
    let metadata = cargo::target_folder(context)?;
    let maker = Maker {
        context,
        condyle: metadata.join("release/condyle"),
        data: context.root.join("../shared/data"),
        out: out.clone(),
    };
    let mut page = page::Page::new();
    let (mut made, mut skipped, mut failed) = (0, vec![], vec![]);
    for paper in &PAPERS {
        page.paper(paper.title);
        for item in paper.items {
            let name = format!("{} {}", paper.key, item.name);
            if only.is_some_and(|only| !name.starts_with(only)) {
                continue;
            }
            let start = Instant::now();
            match maker.item(item) {
                Ok(Some(parts)) => {
                    println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
                    page.item(item, &parts);
                    made += 1;
                }
                Ok(None) => {
                    println!("{name}: skipped, ../shared/data is not there");
                    page.missing(item);
                    skipped.push(name);
                }
                Err(why) => {
                    println!("{name}: FAILED: {why}");
                    failed.push(name);
                }
            }
        }
    }
    let file = out.join("index.html");
    std::fs::write(&file, page.text()).map_err(|error| format!("{}: {error}", file.display()))?;
    println!("{made} made, {} skipped, {} failed: {}", skipped.len(), failed.len(), file.display());
    if failed.is_empty() { Ok(()) } else { Err(failed.join(", ")) }
}

struct Maker<'c> {
    context: &'c Context,
    condyle: PathBuf,
    data: PathBuf,
    out: PathBuf,
}

impl Maker<'_> {
    /// The commands of an item with what came of each; `None` where recordings are missing.
    fn item(&self, item: &Item) -> Result<Option<Vec<(String, Made)>>, String> {
        let needs = |arguments: &[&str]| arguments.iter().any(|a| a.contains("DATA/"));
        let missing = !self.data.is_dir()
            && item.steps.iter().any(|step| match step {
                Step::Run(arguments, _) | Step::Cargo(arguments, _) => needs(arguments),
                _ => false,
            });
        if missing {
            return Ok(None);
        }
        let mut parts = vec![];
        for step in item.steps {
            parts.push(self.step(step)?);
        }
        Ok(Some(parts))
    }

    fn step(&self, step: &Step) -> Result<(String, Made), String> {
        match step {
            Step::File(name, text) => {
                self.write(name, text)?;
                Ok((format!("{name}:"), Made::Text((*text).to_owned())))
            }
            Step::Run(arguments, lines) => {
                let mut command = Command::new(&self.condyle);
                command
                    .current_dir(&self.context.root)
                    .args(arguments.iter().map(|a| self.filled(a)));
                let said = said(&mut command, &[0, 1], *lines)?;
                Ok((format!("condyle {}", shown(arguments)), text(said)))
            }
            Step::Cargo(arguments, lines) => {
                let mut command = cargo::command(self.context);
                command.args(arguments.iter().map(|a| self.filled(a)));
                let said = said(&mut command, &[0], *lines)?;
                // A name that no test has runs none, and says that all is well.
                if said.contains("ok. 0 passed") {
                    return Err(format!("cargo {} ran no test", shown(arguments)));
                }
                Ok((format!("cargo {}", shown(arguments)), text(said)))
            }
            Step::Graph(model, set, name) => {
                let mut command = Command::new(&self.condyle);
                command.current_dir(&self.context.root).args(["info", model, "--json"]);
                let answer = said(&mut command, &[0], usize::MAX)?;
                let drawn = graph::svg(&answer, set)?;
                self.write(name, &drawn)?;
                Ok((
                    format!("condyle info {model} --json ({set})"),
                    Made::Picture((*name).to_owned()),
                ))
            }
            Step::Picture(name) => {
                if !self.out.join(name).is_file() {
                    return Err(format!("{name} was not written"));
                }
                Ok((String::new(), Made::Picture((*name).to_owned())))
            }
            Step::Manual(name) => {
                let from = self.context.root.join("docs/pictures").join(name);
                let copied = std::fs::copy(&from, self.out.join(name));
                copied.map_err(|error| format!("{}: {error}", from.display()))?;
                Ok((format!("docs/pictures/make.sh ({name})"), Made::Picture((*name).to_owned())))
            }
        }
    }

    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        let path = self.out.join(name);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    }

    fn filled(&self, argument: &str) -> String {
        let folder = |path: &Path| format!("{}/", path.display());
        argument.replace("OUT/", &folder(&self.out)).replace("DATA/", &folder(&self.data))
    }
}

fn shown(arguments: &[&str]) -> String {
    arguments.join(" ").replace("OUT/", "").replace("DATA/", "../shared/data/")
}

fn text(said: String) -> Made {
    if said.is_empty() { Made::Nothing } else { Made::Text(said) }
}

/// The last lines that a command prints on standard output.
fn said(command: &mut Command, good: &[i32], lines: usize) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if !output.status.code().is_some_and(|code| good.contains(&code)) {
        let why = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("{command:?} ended with {}: {why}", output.status));
    }
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let all: Vec<&str> = said.lines().collect();
    Ok(all[all.len().saturating_sub(lines)..].join("\n"))
}
