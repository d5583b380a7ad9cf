//! Medium access and queues.

use super::special::root;

/// Each of `robots` queues is on air for a share ρ = `load` of the time: none of the others is as a frame begins, and none begins meanwhile.
pub fn pure_aloha(robots: i32, load: f64) -> f64 {
    ((1.0 - load) * (-load).exp()).powi(robots - 1)
}

/// A frame under saturation: τ, the chance that a station sends in a slot, and p, that another does too (Bianchi, 2000), with `attempts` at most, windows from `window`
/// slots on, doubled `doublings` times.
pub fn bianchi(robots: i32, window: f64, doublings: i32, attempts: i32) -> (f64, f64) {
    let tau = |p: f64| {
        let tried = |attempt: i32| p.powi(attempt);
        let slots = |attempt: i32| tried(attempt) * ((window * 2_f64.powi(attempt.min(doublings)) - 1.0) / 2.0 + 1.0);
        (0..attempts).map(tried).sum::<f64>() / (0..attempts).map(slots).sum::<f64>()
    };
    let p = root(0.0, 1.0 - 1e-9, |p| 1.0 - (1.0 - tau(p)).powi(robots - 1) - p);
    (tau(p), p)
}

/// Times of a saturated cell, µs.
pub struct Cell {
    pub slot: f64,
    /// A frame on air, what follows until the next slot where it is acknowledged, and where it is not.
    pub frame: f64,
    pub acknowledged: f64,
    pub collided: f64,
}

/// Bits that a saturated cell of `robots` carries in a microsecond, frames of so many `bits`.
pub fn saturation(robots: i32, tau: f64, bits: f64, cell: &Cell) -> f64 {
    let some = 1.0 - (1.0 - tau).powi(robots);
    let one = f64::from(robots) * tau * (1.0 - tau).powi(robots - 1);
    let time =
        (1.0 - some) * cell.slot + one * (cell.frame + cell.acknowledged) + (some - one) * (cell.frame + cell.collided);
    one * bits / time
}

/// The mean wait in M/D/1, in service times.
pub fn m_d_1(load: f64) -> f64 {
    load / (2.0 * (1.0 - load))
}

/// The mean time until all of `robots` know a rumour that each passes on at a `rate` to one of the others: Σ (N − 1)/(β n (N − n)).
pub fn epidemic(robots: u32, rate: f64) -> f64 {
    let n = f64::from(robots);
    (1..robots)
        .map(|knows| (n - 1.0) / (rate * f64::from(knows) * (n - f64::from(knows))))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_have_the_figures_of_another_program() {
        let near = |found: f64, known: f64| assert!((found / known - 1.0).abs() < 5e-4, "{found} for {known}");
        near(pure_aloha(50, 4.0 * 1.184e-3), 0.6283);
        let (tau, p) = bianchi(10, 32.0, 5, 7);
        near(p, 0.2902);
        let cell = Cell {
            slot: 20.0,
            frame: 8480.0,
            acknowledged: 364.0,
            collided: 50.0,
        };
        near(saturation(10, tau, 8000.0, &cell), 0.7582);
        near(epidemic(20, 1.0), 6.741);
    }
}
