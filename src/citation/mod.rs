//! What to cite for a result: the program, the paper that it implements, the methods that were used and the sources of materials.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use serde_json::{Value, json};

use crate::material::library::{self, LibraryEntry};
use crate::sweep::plan::resolved::material_text;
use crate::sweep::store::manifest::Kind;

/// A work of `works.bib`.
#[derive(Debug, Clone, PartialEq)]
pub struct Work {
    /// `article`, `book` or `misc`.
    kind: String,
    key: String,
    /// In the order of the file, with the marks of BibTeX.
    fields: Vec<(String, String)>,
}

/// What is cited of any result.
const IMPLEMENTED: &str = "the paper that is implemented";

static WORKS: LazyLock<Vec<Work>> = LazyLock::new(|| works(include_str!("works.bib")));

/// The paper that the program implements.
pub fn implemented() -> &'static Work {
    &WORKS[0]
}

/// The entries of a file that has a field a line, and every brace that closes one on a line of its own.
fn works(text: &str) -> Vec<Work> {
    let mut works: Vec<Work> = Vec::new();
    for line in text.lines().map(str::trim) {
        let head = line.strip_prefix('@').and_then(|head| head.split_once('{'));
        if let Some((kind, key)) = head {
            works.push(Work {
                kind: kind.to_owned(),
                key: key.trim_end_matches(',').to_owned(),
                fields: Vec::new(),
            });
        } else if let (Some((name, value)), Some(work)) =
            (line.split_once(" = {"), works.last_mut())
        {
            let value = value.trim_end_matches(',');
            let value = value.strip_suffix('}').unwrap_or(value);
            work.fields.push((name.to_owned(), value.to_owned()));
        }
    }
    works
}

impl Work {
    /// The program itself, in the version that made a result.
    fn program(made_by: &MadeBy) -> Self {
        let mut fields = vec![
            ("author", format!("{{{}}}", env!("CARGO_PKG_AUTHORS"))),
            (
                "title",
                format!("{{contact-dma}}: {}", env!("CARGO_PKG_DESCRIPTION")),
            ),
            ("version", made_by.version.clone()),
            ("url", env!("CARGO_PKG_REPOSITORY").to_owned()),
        ];
        let build = made_by.build.iter().map(|build| format!("build {build}"));
        let commit = made_by
            .commit
            .iter()
            .map(|commit| format!("commit {commit}"));
        let note = build.chain(commit).collect::<Vec<_>>().join(", ");
        if !note.is_empty() {
            fields.push(("note", note));
        }
        fields.push(("keywords", "the program".to_owned()));
        let fields = fields.into_iter();
        Self {
            kind: "software".to_owned(),
            key: "contact-dma".to_owned(),
            fields: fields
                .map(|(name, value)| (name.to_owned(), value))
                .collect(),
        }
    }

    /// What it has under this name.
    pub fn field(&self, name: &str) -> Option<&str> {
        let mut fields = self.fields.iter();
        fields
            .find(|(other, _)| other == name)
            .map(|(_, value)| value.as_str())
    }

    /// What it is cited for.
    fn is_for(&self) -> impl Iterator<Item = &str> {
        self.field("keywords").unwrap_or_default().split(", ")
    }

    /// Its entry in a bibliography of BibTeX.
    pub fn bibtex(&self) -> String {
        let fields = self.fields.iter().filter(|(name, _)| name != "keywords");
        let fields: String = fields
            .map(|(name, value)| format!("  {name} = {{{value}}},\n"))
            .collect();
        // Styles of BibTeX itself know no software.
        let kind = if self.kind == "software" {
            "misc"
        } else {
            &self.kind
        };
        format!("@{kind}{{{},\n{fields}}}\n", self.key)
    }

    /// The work in a list of references.
    pub fn prose(&self) -> String {
        let mut parts = Vec::new();
        if let Some(authors) = self.field("author") {
            let authors: Vec<&str> = authors.split(" and ").collect();
            parts.push(match &authors[..] {
                [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
                _ => authors.concat(),
            });
        }
        parts.extend(self.field("title").map(str::to_owned));
        let journal = self
            .field("journal")
            .map(|journal| match self.field("volume") {
                // A volume that is the year says nothing more.
                Some(volume) if self.field("year") != Some(volume) => format!("{journal} {volume}"),
                _ => journal.to_owned(),
            });
        let place = journal.or(self.field("publisher").map(str::to_owned));
        let year = self.field("year").map(|year| format!("({year})"));
        let pages = self.field("pages").map(str::to_owned);
        let place: Vec<String> = [place, year, pages].into_iter().flatten().collect();
        if !place.is_empty() {
            parts.push(place.join(" "));
        }
        parts.extend(
            self.field("version")
                .map(|version| format!("version {version}")),
        );
        parts.extend(self.field("note").map(str::to_owned));
        parts.extend(self.field("doi").map(|doi| format!("doi:{doi}")));
        parts.extend(self.field("url").map(str::to_owned));
        plain(&parts.join(", "))
    }
}

/// A text without the marks of BibTeX.
fn plain(text: &str) -> String {
    let letters = [
        ("{\\ss}", "ß"),
        ("{\\'o}", "ó"),
        ("\\v{c}", "č"),
        ("--", "-"),
    ];
    let text = letters
        .iter()
        .fold(text.to_owned(), |text, (mark, letter)| {
            text.replace(mark, letter)
        });
    text.replace(['{', '}'], "")
}

/// The program that made a result.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeBy {
    pub version: String,
    pub build: Option<String>,
    pub commit: Option<String>,
}

impl MadeBy {
    /// As `run.json` or `summary.json` of a folder has it; where these say nothing, this program.
    pub fn of(run: &Value) -> Self {
        let text = |key: &str| run[key].as_str().map(str::to_owned);
        let version = text("program_version");
        Self {
            version: version.unwrap_or_else(|| env!("CARGO_PKG_VERSION").to_owned()),
            build: text("build"),
            commit: text("commit"),
        }
    }
}

/// What was used by a result of this kind, whose TOML files say what it is of.
pub fn used(kind: Option<Kind>, files: &[toml::Table]) -> BTreeSet<String> {
    let mut used: BTreeSet<&str> = BTreeSet::from([IMPLEMENTED]);
    used.extend(match kind {
        Some(Kind::Analysis) => Some("moduli of measured loops"),
        Some(Kind::Identification) => Some("identification"),
        Some(Kind::MaterialFit) => Some("fit of a series"),
        Some(Kind::Reproduction) => Some("half-space engine"),
        _ => None,
    });
    let mut tables = Vec::new();
    files.iter().for_each(|file| all_tables(file, &mut tables));
    for table in &tables {
        let has =
            |key: &str, word: &str| table.get(key).and_then(toml::Value::as_str) == Some(word);
        let uses = [
            (has("engine", "axisymmetric"), "axisymmetric engine"),
            (has("engine", "half-space"), "half-space engine"),
            (has("edge", "periodic"), "surface that repeats itself"),
            (
                has("shape", "height-map") || has("shape", "rough"),
                "contact of many patches",
            ),
            // The exact problem of a curve is solved on springs.
            (table.contains_key("curve"), "axisymmetric engine"),
            (
                table.contains_key("drag_height"),
                "drag that falls with the height",
            ),
            (table.contains_key("layer"), "layer"),
            (table.contains_key("adhesion"), "adhesion"),
            (table.contains_key("measured_temperatures"), "master curve"),
            (table.contains_key("wlf"), "shift with the temperature"),
        ];
        used.extend(
            uses.into_iter()
                .filter(|(is_used, _)| *is_used)
                .map(|(_, what)| what),
        );
    }
    let of_library = library::entries().iter().filter(|entry| {
        let own = moduli_of_entry(entry);
        let is_same = |table: &&toml::Table| {
            let name = table.get("name").and_then(toml::Value::as_str);
            name == Some(entry.title) && Some(moduli(table)) == own
        };
        tables.iter().any(is_same)
    });
    let materials: Vec<String> = of_library
        .map(|entry| format!("material {}", entry.name))
        .collect();
    let used = used.into_iter().map(str::to_owned);
    used.chain(materials).collect()
}

/// A table and all that are in it, in lists too.
fn all_tables<'a>(table: &'a toml::Table, found: &mut Vec<&'a toml::Table>) {
    fn below<'a>(value: &'a toml::Value, found: &mut Vec<&'a toml::Table>) {
        match value {
            toml::Value::Table(table) => all_tables(table, found),
            toml::Value::Array(values) => values.iter().for_each(|value| below(value, found)),
            _ => {}
        }
    }
    found.push(table);
    table.values().for_each(|value| below(value, found));
}

/// The moduli of a series, in whichever table it stands. Its times move with the temperature.
fn moduli(material: &toml::Table) -> Vec<String> {
    let mut tables = Vec::new();
    all_tables(material, &mut tables);
    let texts = tables.iter().flat_map(|table| {
        let values = ["equilibrium", "instantaneous", "modulus"].map(|key| table.get(key));
        values.into_iter().flatten().filter_map(toml::Value::as_str)
    });
    texts.map(str::to_owned).collect()
}

fn moduli_of_entry(entry: &LibraryEntry) -> Option<Vec<String>> {
    let text = material_text(&entry.material().ok()?);
    let file: toml::Table = text.parse().ok()?;
    Some(moduli(file.get("material")?.as_table()?))
}

/// What to cite, and what for.
#[derive(Debug, Clone, PartialEq)]
pub struct Citation {
    pub work: Work,
    pub is_for: String,
}

/// The program and the works for what was used, each once.
pub fn citations(made_by: &MadeBy, used: &BTreeSet<String>) -> Vec<Citation> {
    let program = Work::program(made_by);
    let mut citations = vec![Citation {
        is_for: "the program".to_owned(),
        work: program,
    }];
    for work in WORKS.iter() {
        let is_for: Vec<&str> = work.is_for().filter(|what| used.contains(*what)).collect();
        if !is_for.is_empty() {
            citations.push(Citation {
                work: work.clone(),
                is_for: is_for.join(", "),
            });
        }
    }
    citations
}

impl Citation {
    /// For other programs.
    pub fn to_json(&self) -> Value {
        let bibtex = self.work.bibtex();
        json!({ "key": self.work.key, "for": self.is_for, "reference": self.work.prose(), "bibtex": bibtex })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sources_of_the_library_and_the_works_that_are_cited_for_it_are_the_same() {
        for entry in library::entries() {
            let what = format!("material {}", entry.name);
            let cited: Vec<&Work> = WORKS
                .iter()
                .filter(|work| work.is_for().any(|w| w == what))
                .collect();
            assert!(!cited.is_empty(), "{what}");
            for work in cited {
                let doi = work.field("doi").into_iter();
                let number = ["volume", "year"]
                    .into_iter()
                    .filter_map(|name| work.field(name));
                for part in doi.chain(number) {
                    assert!(entry.source.contains(part), "{}: {part}", work.key);
                }
                let author = work.field("author").map(plain);
                let last = author.as_deref().and_then(|all| all.rsplit(' ').next());
                assert!(
                    last.is_none_or(|name| entry.source.contains(name)),
                    "{}",
                    work.key
                );
            }
        }
    }

    #[test]
    fn every_work_is_for_something_that_can_be_used_and_prints_without_marks() {
        let everything: &str = include_str!("mod.rs");
        for work in WORKS.iter() {
            for what in work.is_for() {
                let is_known = match what.strip_prefix("material ") {
                    Some(name) => library::find(name).is_some(),
                    None => everything.contains(&format!("\"{what}\"")),
                };
                assert!(is_known, "{}: {what}", work.key);
            }
            assert!(!work.prose().contains(['{', '}', '\\']), "{}", work.prose());
        }
        assert_eq!(
            WORKS.len(),
            include_str!("works.bib").matches("\n@").count()
        );
        let spinu = &WORKS[0];
        assert_eq!(
            spinu.prose(),
            "S. Spinu, Viscoelastic Contact Simulation under Harmonic Cyclic Load, Advances in Tribology (2018) 9432894, \
             doi:10.1155/2018/9432894"
        );
        assert_eq!(
            works(&spinu.bibtex())[0].fields,
            spinu.fields[..spinu.fields.len() - 1]
        );
    }

    #[test]
    fn a_material_is_of_the_library_by_its_moduli_and_its_name_at_any_temperature() {
        let of = |text: &str| used(Some(Kind::Sweep), &[text.parse().unwrap()]);
        for entry in library::entries() {
            let text = material_text(&entry.material().unwrap());
            let what = format!("material {}", entry.name);
            assert!(of(&text).contains(&what), "{what}");
            let renamed = text.replace(&format!("name = \"{}\"", entry.title), "name = \"mine\"");
            assert!(!of(&renamed).contains(&what), "{what}");
            let other = text.replacen(" Pa\"", "1 Pa\"", 1);
            assert!(!of(&other).contains(&what), "{what}");
        }
    }
}
