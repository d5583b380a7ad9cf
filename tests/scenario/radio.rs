//! Malformed radios: each is refused at its field, with what would be right.

use desim::scenario::parse;

fn refusal(radio: &str, rest: &str) -> String {
    let text = format!(
        "Scenario(\n    name: \"radio\",\n    time_limit: 10.0,\n    swarm: (robots: 5, deploy: Uniform),\n    radio: Shared({radio}),\n    {rest}\n)"
    );
    let report = parse("radio.ron", &text, &[]).expect_err(radio);
    // Messages are wrapped.
    let report = report.to_string().replace('│', " ");
    report.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn each_is_refused_at_its_field_with_a_remedy() {
    const STATUSES: &str = "protocol: Heartbeat";
    for (radio, rest, field, remedy) in [
        (
            "technology: Wifi(standard: B, rate: 3e6)",
            STATUSES,
            "radio.technology.rate",
            "expected one of 1e6, 2e6, 5.5e6, 1.1e7",
        ),
        (
            "technology: Wifi(standard: G, rate: 11e6)",
            STATUSES,
            "radio.technology.rate",
            "expected one of 6e6",
        ),
        (
            "technology: Wifi(standard: B, rate: 1e6, preamble: Short)",
            STATUSES,
            "radio.technology.preamble",
            "use Long",
        ),
        (
            "technology: LoRa(spreading: 13)",
            STATUSES,
            "radio.technology.spreading",
            "7",
        ),
        ("technology: EPuck()", STATUSES, "radio", "longer frames"),
        (
            "technology: BleAdvertising()",
            "protocol: Traffic(payload: 40)",
            "protocol.payload",
            "at most 31",
        ),
        (
            "technology: Ieee802154()",
            "protocol: Traffic(payload: 200)",
            "protocol.payload",
            "at most 116",
        ),
        (
            "technology: Ieee802154(), access: Tdma(slot: 0.002, slots: 10, frame: 0.01)",
            STATUSES,
            "radio.access.frame",
            "at least 0.02 s",
        ),
        (
            "technology: Ieee802154(), access: Tdma(slot: 0.0005)",
            STATUSES,
            "radio.access.slot",
            "make the slot longer",
        ),
        (
            "technology: Ieee802154(), access: SlottedAloha(slot: 0.0001, probability: 0.1)",
            STATUSES,
            "radio.access.slot",
            "make the slot longer",
        ),
        (
            "technology: Ieee802154(), access: Aloha(duty_cycle: Some(0.0))",
            STATUSES,
            "radio.access.duty_cycle",
            "a share above 0",
        ),
        (
            "technology: Ieee802154(), queue: 0",
            STATUSES,
            "radio.queue",
            "at least 1",
        ),
        (
            "technology: Ieee802154(), capture: -1.0",
            STATUSES,
            "radio.capture",
            "at least 0 dB",
        ),
        (
            "technology: Ieee802154(), fading: Nakagami(m: 0.1)",
            STATUSES,
            "radio.fading.m",
            "0.5",
        ),
        (
            "technology: Ieee802145()",
            STATUSES,
            "radio.technology",
            "did you mean `Ieee802154`?",
        ),
    ] {
        let report = refusal(radio, rest);
        assert!(report.contains(field), "{radio}: {field}\n{report}");
        assert!(report.contains(remedy), "{radio}: {remedy}\n{report}");
        assert!(report.contains("radio.ron:"), "{radio}: where\n{report}");
    }
}
