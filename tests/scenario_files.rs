//! Scenario files: what ships is well, overrides reach every field, and mistakes are named where they stand.

use std::path::PathBuf;

use desim::scenario::{Override, Report, Scenario, parse, question, to_ron};

const BASE: &str = r#"// Does it work?
Scenario(
    name: "base",
    time_limit: 60.0,
    swarm: (robots: 40, deploy: Cluster(radius: 1.5)),
    protocol: Backbone(targets: Ring(count: 4, radius: 4.5, links: 2)),
    radio: (range: 2.0, loss: Bernoulli(0.2)),
)
"#;

fn read(text: &str, overrides: &[&str]) -> Result<Scenario, Report> {
    let overrides: Vec<Override> = overrides.iter().map(|text| text.parse()).collect::<Result<_, _>>()?;
    parse("base.ron", text, &overrides)
}

fn shown(text: &str, overrides: &[&str]) -> String {
    read(text, overrides).expect_err("the scenario is wrong").to_string()
}

#[test]
fn probe() {
    let subs: &[(&str, &str)] = &[
        ("loss: Bernoulli", "los: Bernoulli"), ("Bernoulli", "Bernouli"), ("Bernoulli(0.2)", "Bernoulli(1.2)"), ("Bernoulli(0.2)", "Bernoulli"),
        ("Bernoulli(0.2)", "3"), ("(range: 2.0, loss: Bernoulli(0.2))", "3"), ("range: 2.0", "range: -1"), ("range: 2.0", "range: \"x\""), ("range: 2.0", "range: 2 m"),
        ("radio:", "motion: (linear: (p: 1)), radio:"), ("radio:", "arena: (size: (1.0, -2.0)), radio:"), ("radio:", "arena: (size: (1.0)), radio:"), ("radio:", "arena: (size: (1.0, 2, 3)), radio:"),
        ("robots: 40", "robots: 40.5"), ("robots: 40", "robots: -3"), ("robots: 40", "robots: 99999999999"), ("robots: 40", "robots: 0"), ("robots: 40", "robots: 4, robots: 5"),
        ("radio: (", "radio: Radio("), ("Bernoulli(0.2)", "Bernoulli((0.2))"), ("Backbone(targets: Ring(count: 4, radius: 4.5, links: 2))", "Backbone((targets: Ring(count: 4, radius: 4.5, links: 2)))"),
        ("Scenario", "Scenaro"), ("time_limit: 60.0,", ""), ("time_limit: 60.0,", "time_limit: 60.0"), ("Scenario", ""), (BASE, ""), (BASE, "// x"), ("4.5, links: 2))", "4.5, links: 2)"), ("deploy: Cluster(radius: 1.5)", "deploy: At([(0,0)])"),
        ("name: \"base\"", "name: \"a/b\""), ("name: \"base\"", "name: base"), ("time_limit: 60.0", "time_limit: 5"), ("count: 4", "count: 400"), ("radius: 4.5,", ""),
        ("name: \"base\"", "name: \"base"), ("range: 2.0", "range: 2.0, latency: \"x\""), ("range: 2.0", "range: 1_0.0"),("range: 2.0", "range: _0.0"), ("name: \"base\"", "name: \"\\q\""),
        ("radio:", "metrics: (sample_interval: 1e-9), control: (period: 0.25), radio:"), ("protocol:", "protocol: Heartbeat(), proto:"), ("radio:", "radio = "),
    ];
    for (from, to) in subs {
        let text = BASE.replace(from, to);
        println!("=== {from} -> {to}\n{}", match read(&text, &[]) { Ok(_) => "OK".into(), Err(report) => report.to_string() });
    }
    for set in ["radio.los=Bernoulli(0.3)", "radio.loss=Bernoulli(3)", "protocol.Backbone.targets.Ring.links=3", "protocol.targets.links=3", "protocol.targets.links=x", "protocol.Heartbeat.links=x", "radio.loss.Bernoulli=0.4",
        "radio.loss.None=1", "radio.loss.Gilbert.a=1", "motion.linear.p=3", "motion.linear.q=3", "motion.linear=(p:3)", "detector.Timeout=3", "gossip.status.interval=-1", "name=other", "trials=5", "seed=x", "foo", "a..b=1", "a=1,b", "radio.loss=", "arena.size[1]=20", "arena.size[2]=20", "swarm.robots.x=3", "arena.size.1=1 // x", "radio.latency.Normal.mean=0.1", "radio.latency=Constant(0.3)", "time_limit=1", "radio.x.y.z=1"] {
        println!("=== --set {set}\n{}", match read(BASE, &[set]) { Ok(s) => format!("{s:?}").replace("Positive","").replace("Finite","").replace("NonNegative", ""), Err(report) => report.to_string() });
    }
    println!("{}", to_ron(&read(BASE, &[]).unwrap()));
    println!("{}", serde_json::to_string_pretty(&desim::scenario::json_schema()).unwrap());
}
