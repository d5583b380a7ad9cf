use super::*;

pub fn ring(count: u8, links: u8) -> BackboneConfig {
    ron::from_str(&format!("(targets: Ring(count: {count}, radius: 4.5, links: {links}))")).unwrap()
}

#[test]
fn four_targets_on_a_ring_lie_on_the_axes() {
    let targets = ring(4, 2).targets();
    let expected = [(4.5, 0.0), (0.0, 4.5), (-4.5, 0.0), (0.0, -4.5)];
    for ((at, links), (x, y)) in targets.into_iter().zip(expected) {
        assert!((at - Vec2::new(x, y)).norm() < 1e-12);
        assert_eq!(links, 2);
    }
}

#[test]
fn four_targets_with_two_relays_a_link_need_a_root_four_workers_and_eight_relays_a_link() {
    assert_eq!([1, 2, 4].map(|links| ring(4, links).robots_needed()), [13, 21, 37]);
}

#[test]
fn the_papers_settings_have_no_problem() {
    assert_eq!(ring(4, 2).own_problems(40, 2.0), []);
}

#[test]
fn each_broken_rule_is_reported_at_its_field() {
    let mut config = ring(4, 0);
    config.motion.movement_gate = Positive::new(1.3);
    config.motion.backbone_avoidance_range = NonNegative::new(1.0);
    config.recruiting.distance_ratio = Positive::new(1.1);
    config.motion.taut_ratio = Probability::new(1.0);
    let problems = config.own_problems(4, 1.5);
    let fields: Vec<&str> = problems.iter().map(|(field, _)| field.as_str()).collect();
    assert_eq!(
        fields,
        [
            "motion.movement_gate",
            "critical_distance",
            "motion.taut_ratio",
            "recruiting.distance_ratio",
            "motion.backbone_avoidance_range",
            "targets",
            "targets",
        ]
    );
    assert_eq!(ring(0, 1).own_problems(40, 2.0).len(), 1);
    assert_eq!(ring(64, 4).own_problems(400, 2.0).len(), 1);
    assert_eq!(ring(4, 1).own_problems(70_000, 2.0).len(), 1);
}
