//! Colours of recordings: those of the pictures and pages, so that a role is the same colour everywhere.

/// A colour, as red, green and blue.
pub type Rgb = [u8; 3];

/// Robots that are linked.
pub const LINK: Rgb = [0x3f, 0xae, 0x49];
/// Obstacles.
pub const OBSTACLE: Rgb = [0x8c, 0x8c, 0x8c];
/// The walls around the arena, and words.
pub const INK: Rgb = [0x4d, 0x4d, 0x4d];
/// Places that robots have to hold.
pub const TARGET: Rgb = [0xc0, 0x00, 0x00];

/// Okabe and Ito's, which colour-blind readers tell apart.
const OTHERS: [Rgb; 7] = [
    [0x00, 0x72, 0xb2],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0xd5, 0x5e, 0x00],
    [0x8c, 0x51, 0x0a],
];

/// The colour of role number `index`, called `name`.
pub fn role_colour(name: &str, index: usize) -> Rgb {
    match name {
        "root" => [0x00, 0x00, 0x00],
        "worker" => [0xd5, 0x5e, 0x00],
        "networker" => [0x00, 0x72, 0xb2],
        "free" => [0x7f, 0x7f, 0x7f],
        _ => OTHERS[(index + 1) % OTHERS.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hexadecimal([red, green, blue]: Rgb) -> String {
        format!("\"#{red:02x}{green:02x}{blue:02x}\"")
    }

    /// The pages are a floor's sibling, which nothing here may use: so their source is read.
    #[test]
    fn roles_have_the_colours_of_the_pages() {
        let pages = include_str!("../../report/html/chart.rs");
        for role in ["root", "worker", "networker", "free"] {
            let arm = format!("\"{role}\" => {}", hexadecimal(role_colour(role, 0)));
            assert!(pages.contains(&arm), "{arm}");
        }
        let others = OTHERS.map(hexadecimal).join(", ");
        let squeezed = pages.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(squeezed.contains(&others), "{others}");
        assert!(pages.contains("TOPICS[(index + 1) % TOPICS.len()]"));
    }
}
