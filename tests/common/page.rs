//! Pages as the tests read them: what they hold, what they load, how they are nested.

#![allow(dead_code)] // Each test file uses its own part.

use std::collections::BTreeSet;

use serde_json::Value;

/// What stands between the first `from` and the next `to`.
pub fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let (_, rest) = text.split_once(from).unwrap();
    rest.split_once(to).unwrap().0
}

pub fn data(page: &str) -> Value {
    let from = "<script type=\"application/json\" id=\"data\">";
    let json = between(page, from, "</script>");
    serde_json::from_str(json).unwrap()
}

/// Undoes the five escapes.
pub fn unescaped(text: &str) -> String {
    let escapes = "&lt; < &gt; > &quot; \" &#39; ' &amp; &";
    let escapes: Vec<&str> = escapes.split(' ').collect();
    let undone = |text: String, pair: &[&str]| text.replace(pair[0], pair[1]);
    escapes.chunks(2).fold(text.to_owned(), undone)
}

/// Names of the elements that are opened and not closed in order, by a reader that knows tags and nothing else.
pub fn nesting_problems(page: &str) -> Vec<String> {
    const VOID: [&str; 5] = ["meta", "link", "input", "br", "img"];
    let (mut open, mut problems) = (Vec::new(), Vec::new());
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        let (tag, after) = rest.split_once('>').unwrap();
        rest = after;
        if tag.starts_with('!') {
            continue;
        }
        let name = tag
            .trim_start_matches('/')
            .split(|c: char| !c.is_alphanumeric());
        let name = name.into_iter().next().unwrap().to_owned();
        if tag.starts_with('/') {
            if open.pop() != Some(name.clone()) {
                problems.push(format!("</{name}> closes something else"));
            }
        } else if !tag.ends_with('/') && !VOID.contains(&name.as_str()) {
            if ["script", "style"].contains(&name.as_str()) {
                // What they hold is no HTML.
                let end = format!("</{name}>");
                rest = rest.split_once(end.as_str()).unwrap().1;
            } else {
                open.push(name);
            }
        }
    }
    problems.extend(open.iter().map(|name| format!("<{name}> is never closed")));
    problems
}

/// Holds a page to loading nothing but pictures of its folder, to closing what it opens, and to one element for each name.
pub fn assert_stands_alone(page: &str) {
    let of_folder = "<img loading=\"lazy\" src=\"figures/";
    assert_eq!(
        page.matches("src=").count(),
        page.matches(of_folder).count()
    );
    for load in [
        "@import", "url(http", "url(/", "<iframe", "<object", "<base", "fetch(", "import(",
    ] {
        assert!(!page.contains(load), "{load}");
    }
    // Addresses of other machines stand in links that a person may follow, and nowhere else.
    for (at, _) in page.match_indices("http") {
        let before = &page[..at];
        let after = &page[at..];
        if after.starts_with("http://") || after.starts_with("https://") {
            assert!(before.ends_with("<a href=\""), "{}", &after[..60]);
        }
    }
    assert_eq!(nesting_problems(page), Vec::<String>::new());
    let ids = page.split(" id=\"").skip(1);
    let ids: Vec<&str> = ids.map(|rest| rest.split('"').next().unwrap()).collect();
    let distinct: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), distinct.len(), "two elements share a name");
}
