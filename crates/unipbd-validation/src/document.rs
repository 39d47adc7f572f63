//! Documents that are written section by section: a run renews what it has measured, the rest stays.

/// A document with this introduction before its first section.
pub fn with_introduction(document: &str, introduction: &str) -> String {
    let rest = document.find("\n## ").map_or("", |start| &document[start..]);
    format!("{}\n{rest}", introduction.trim_end())
}

/// A document with this section: in place of the one of the same heading, or else at the end.
pub fn with_section(document: &str, heading: &str, body: &str) -> String {
    let (title, section) = (format!("## {heading}\n"), format!("## {heading}\n\n{}\n", body.trim_end()));
    let Some(start) = document.find(&format!("\n{title}")).map(|start| start + 1) else {
        return format!("{}\n\n{section}", document.trim_end());
    };
    let rest = &document[start + title.len()..];
    let rest = rest.find("\n## ").map_or("", |end| &rest[end..]);
    format!("{}{section}{rest}", &document[..start])
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCUMENT: &str = "# Title\n\n## One\n\nold\n\n## Two\n\nstays\n";

    #[test]
    fn a_section_is_put_in_place_of_the_old_one_or_at_the_end() {
        assert_eq!(with_section(DOCUMENT, "One", "new\n"), "# Title\n\n## One\n\nnew\n\n## Two\n\nstays\n");
        assert_eq!(with_section(DOCUMENT, "Two", "new"), "# Title\n\n## One\n\nold\n\n## Two\n\nnew\n");
        let longer = with_section(DOCUMENT, "Three", "new");
        assert_eq!(longer, format!("{DOCUMENT}\n## Three\n\nnew\n"));
        assert_eq!(with_section(&longer, "Three", "new"), longer);
    }

    #[test]
    fn an_introduction_takes_the_place_of_all_before_the_first_section() {
        assert_eq!(with_introduction(DOCUMENT, "# New\n"), "# New\n\n## One\n\nold\n\n## Two\n\nstays\n");
        assert_eq!(with_introduction("", "# New\n"), "# New\n");
    }
}
