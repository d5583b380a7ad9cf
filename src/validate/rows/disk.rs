//! The disk radio: loss and latency; graphs; rumours.

use std::f64::consts::PI;

use super::{Row, Setting};
use crate::validate::forms::access::epidemic;
use crate::validate::forms::special::normal;
use crate::validate::reading;

fn sections<const N: usize>(seconds: f64, sections: [&str; N]) -> Setting {
    (seconds, sections.map(str::to_owned).to_vec())
}

fn chat(seconds: f64, swarm: &str, radio: &str) -> Setting {
    sections(
        seconds,
        [
            swarm,
            "control: (period: 1.0, phase: Together)",
            "protocol: Traffic(when: Poisson(10.0), payload: 20)",
            radio,
            "metrics: (sample_interval: 0.0)",
        ],
    )
}

const CLUSTER: &str = "swarm: (robots: 10, deploy: Cluster(radius: 0.9))";

pub fn rows() -> Vec<Row> {
    let mut rows = losses();
    rows.extend(latencies());
    rows.extend(graphs());
    let setting = sections(
        200.0,
        [
            "swarm: (robots: 20, deploy: Cluster(radius: 0.9))",
            "protocol: Rumor(rounds: Poisson, completion: Reached)",
            "gossip: (relay: (interval: 0.5, fan_out: Peers(1)))",
            "radio: (loss: Bernoulli(0.5), latency: Constant(0.0))",
            "metrics: (sample_interval: 0.0)",
        ],
    );
    rows.push(
        Row::new("rumours", "rumours.push", (epidemic(20, 1.0), "s"), setting, reading::spread_time)
            .trials(1500)
            .form("time to all: Σ (N − 1)/(β n (N − n)), n = 1…N − 1, N = 20; 2 /s, half of them lost: β = 1 /s (SI epidemic)"),
    );
    rows
}

fn losses() -> Vec<Row> {
    const MODEL: &str = "disk: loss";
    let lossy = |name: &str, expected: f64, radio: &str| {
        Row::new(MODEL, name, (expected, ""), chat(30.0, CLUSTER, radio), reading::lost)
    };
    let bursts = |p: f64, r: f64| {
        format!("radio: (loss: GilbertElliott(good_to_bad: {p:?}, bad_to_good: {r:?}), latency: Constant(0.0))")
    };
    let pair = super::pair(1.0);
    let far = chat(
        30.0,
        &pair,
        "radio: (range: 2.0, loss: Distance(at_range: 0.5, exponent: 3.0), latency: Constant(0.0))",
    );
    vec![
        lossy(
            "loss.bernoulli",
            0.2,
            "radio: (loss: Bernoulli(0.2), latency: Constant(0.0))",
        )
        .form("p = 0.2"),
        lossy("loss.gilbert-elliott", 0.2, &bursts(0.05, 0.2)).form("p/(p + r), p = 0.05, r = 0.2 (Gilbert, 1960)"),
        Row::new(
            MODEL,
            "loss.burst",
            (5.0, ""),
            watched("GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2)"),
            reading::losses_a_suspicion(1.0),
        )
        .form("frames lost in a row: 1/r, r = 0.2 (Gilbert, 1960)")
        .within(
            0.002,
            "what is lost before the first status arrives begins no suspicion",
        ),
        Row::new(MODEL, "loss.distance", (0.0625, ""), far, reading::lost).form("p (d/R)^e, p = 0.5, d/R = ½, e = 3"),
    ]
}

/// A detector that suspects whoever misses a status.
fn watched(loss: &str) -> Setting {
    let radio = format!("radio: (loss: {loss}, latency: Constant(0.0))");
    sections(
        200.0,
        [
            CLUSTER,
            "control: (period: 0.1, phase: Random)",
            "protocol: Heartbeat",
            "gossip: (status: (interval: 0.1))",
            "detector: Timeout(0.15)",
            &radio,
            "metrics: (sample_interval: 0.0)",
        ],
    )
}

fn latencies() -> Vec<Row> {
    let row = |name: &str, law: &str, seconds: f64, form: &str| {
        let setting = chat(60.0, CLUSTER, &format!("radio: (latency: {law})"));
        Row::new(
            "disk: latency",
            format!("latency.{name}"),
            (1e3 * seconds, "ms"),
            setting,
            reading::latency(1e-3),
        )
        .trials(12)
        .form(form)
        .within(
            0.001,
            "what is still under way at the end is not counted, and takes longest",
        )
    };
    let density = (-0.5_f64).exp() / (2.0 * PI).sqrt();
    vec![
        row(
            "uniform",
            "Uniform(min: 0.01, max: 0.05)",
            0.03,
            "(a + b)/2, a = 10 ms, b = 50 ms",
        ),
        row(
            "log-normal",
            "LogNormal(median: 0.02, sigma: 0.5)",
            0.02 * 0.125_f64.exp(),
            "m e^(σ²/2), m = 20 ms, σ = 0.5",
        ),
        row("gamma", "Gamma(shape: 2.0, scale: 0.01)", 0.02, "kθ, k = 2, θ = 10 ms"),
        row(
            "normal",
            "Normal(mean: 0.01, std_dev: 0.01)",
            0.01 + 0.01 * density / normal(1.0),
            "μ + σ φ(1)/Φ(1): normal, drawn again below 0, μ = σ = 10 ms",
        ),
    ]
}

/// Algebraic connectivity of known graphs (Fiedler, 1973).
fn graphs() -> Vec<Row> {
    let row = |name: &str, places: Vec<(f64, f64)>, expected: f64, form: &str| {
        let robots = places.len();
        let places: Vec<String> = places.iter().map(|(x, y)| format!("({x:?}, {y:?})")).collect();
        let swarm = format!("swarm: (robots: {robots}, deploy: At([{}]))", places.join(", "));
        let setting = sections(
            1.0,
            [
                "arena: (size: (40.0, 40.0))",
                &swarm,
                "protocol: Traffic()",
                "radio: (range: 2.0)",
                "metrics: (sample_interval: 0.5)",
            ],
        );
        Row::new(
            "graph",
            format!("graph.{name}"),
            (expected, ""),
            setting,
            reading::lambda2,
        )
        .exact()
        .form(format!("λ₂ = {form} (Fiedler, 1973)"))
    };
    let path = (0..10).map(|place| (1.5 * f64::from(place) - 6.75, 0.0)).collect();
    let round = |count: i32, radius: f64| {
        let angle = move |place: i32| 2.0 * PI * f64::from(place) / f64::from(count);
        (0..count)
            .map(|place| (radius * angle(place).cos(), radius * angle(place).sin()))
            .collect()
    };
    // Neighbours 1.5 m apart, the next ones 2.85 m.
    let cycle = round(10, 0.75 / (PI / 10.0).sin());
    vec![
        row(
            "path-10",
            path,
            2.0 * (1.0 - (PI / 10.0).cos()),
            "2(1 − cos(π/n)), a path of 10",
        ),
        row(
            "cycle-10",
            cycle,
            2.0 * (1.0 - (2.0 * PI / 10.0).cos()),
            "2(1 − cos(2π/n)), a cycle of 10",
        ),
        row("complete-6", round(6, 0.8), 6.0, "n, all 6 in range of each other"),
    ]
}
