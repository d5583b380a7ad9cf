//! In place of drawing, in a build without the `command` feature: what is wrong with a scenario in a line each, with what to do about it
//! below.

use super::diagnostic::{Diagnostic, Kind};
use crate::text::{Style, clean_lines};

/// All of `diagnostics`, one below the other.
pub fn all(diagnostics: &[Diagnostic], kind: Kind, _: Style) -> String {
    let mut text = String::new();
    for Diagnostic {
        message, help, place, ..
    } in diagnostics
    {
        let at = place
            .as_ref()
            .map(|place| format!("{}:{}:{}: ", place.name, place.line, place.column));
        let line = format!("{}{}{message}", kind.prefix(), at.unwrap_or_default());
        text.extend([&clean_lines(&line), "\n"]);
        if let Some(help) = help {
            text.extend(["  help: ", &clean_lines(help), "\n"]);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::scenario::parse;

    #[test]
    fn a_fault_is_a_line_with_its_place_and_a_line_with_what_to_do() {
        let unit = crate::kinds::all().into_iter().find(|kind| kind.is_unit);
        let protocol = unit.expect("such a protocol is shipped").name;
        let text = format!(
            "Scenario(name: \"a\", time_limit: 10.0, swarm: (robots: 2, deploy: Uniform),\n  protocol: {protocol}, radio: (rnage: 1.5))"
        );
        let report = parse("a.ron", &text, &[]).unwrap_err().to_string();
        let lines: Vec<&str> = report.lines().collect();
        assert_eq!(lines.len(), 2, "{report}");
        assert!(
            lines[0].starts_with("a.ron:2:") && lines[0].contains("rnage"),
            "{report}"
        );
        assert!(lines[1].starts_with("  help: "), "{report}");
    }
}
