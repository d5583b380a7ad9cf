use super::*;

fn mission(links: u8, poses: &[(f64, f64)]) -> Mission {
    let config: BackboneConfig =
        ron::from_str(&format!("(targets: Ring(count: 4, radius: 4.5, links: {links}))")).unwrap();
    let parameters = Parameters::new(
        &config,
        &GossipConfig::default(),
        (
            &DetectorConfig::default(),
            Circumstances {
                robots: poses.len(),
                status_interval: Span::from_secs(0.1),
            },
        ),
        &ControlConfig::default(),
        Streams::new(1, 0),
    );
    let poses: Vec<Pose> = poses
        .iter()
        .map(|&(x, y)| Pose {
            position: Vec2::new(x, y),
            heading: 0.0,
        })
        .collect();
    Mission::new(&config, parameters, &poses)
}

#[test]
fn the_root_is_the_most_central_robot_and_each_worker_the_nearest_one_left() {
    let mission = mission(
        1,
        &[(0.5, 0.0), (0.1, 0.0), (0.6, 0.1), (0.0, 0.5), (-0.5, 0.0), (0.0, -0.5)],
    );
    assert_eq!(mission.root, ActorId(1));
    let workers: Vec<u32> = mission.targets.iter().map(|target| target.worker.0).collect();
    assert_eq!(workers, [2, 3, 4, 5]);
    assert_eq!(mission.worker_target(ActorId(4)), Some(2));
    assert_eq!(mission.worker_target(ActorId(0)), None);
}

#[test]
fn the_papers_targets_need_two_relays_a_chain() {
    assert_eq!(relays_needed(4.5, 0.3, 1.4), 2);
    assert_eq!(relays_needed(4.6, 0.3, 1.4), 3);
    assert_eq!(relays_needed(1.0, 0.3, 1.4), 0);
    assert_eq!(relays_needed(0.1, 0.3, 1.4), 0);
}

#[test]
fn chains_are_numbered_from_one_and_lie_symmetrically_beside_the_straight_line() {
    let mission = mission(3, &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]);
    assert_eq!(mission.chains.len(), 12);
    assert_eq!(mission.targets[1].chains, 4..7);
    let lanes: Vec<f64> = (4..7).map(|number| mission.chain(number).lane).collect();
    assert_eq!(lanes, [-0.35, 0.0, 0.35]);
    assert!(mission.has_chain(12) && !mission.has_chain(13) && !mission.has_chain(0));
}

#[test]
fn all_chains_but_one_to_a_near_target_have_a_relay_so_that_they_are_disjoint() {
    let config: BackboneConfig = ron::from_str("(targets: Ring(count: 1, radius: 1.2, links: 3))").unwrap();
    let relays: Vec<usize> = parallel_chains(&config, 0, Vec2::new(1.2, 0.0), 3)
        .map(|chain| chain.relays)
        .collect();
    assert_eq!(relays, [0, 1, 1]);
}

#[test]
fn with_a_reserve_the_springs_still_add_up_to_the_same_and_the_last_is_half_as_long() {
    let config: BackboneConfig = ron::from_str("(targets: Ring(count: 1, radius: 4.5))").unwrap();
    let chain = parallel_chains(&config, 0, Vec2::new(4.5, 0.0), 1).next().unwrap();
    for relays in [3, 4] {
        let springs = chain.springs(relays);
        let whole = relays as f64 * springs.between + springs.last;
        assert!((whole - 3.0 * chain.rest).abs() < 1e-12);
        assert!((springs.last - 0.5 * springs.between).abs() < 1e-12);
    }
    for relays in [1, 2] {
        let springs = chain.springs(relays);
        assert_eq!((springs.between, springs.last), (chain.rest, chain.rest));
    }
}

#[test]
fn springs_are_shorter_than_the_even_spacing_so_that_a_finished_chain_is_taut() {
    for distance in [2.0, 3.2, 4.5, 6.4] {
        let config: BackboneConfig =
            ron::from_str(&format!("(targets: Ring(count: 1, radius: {distance:?}))")).unwrap();
        let chain = parallel_chains(&config, 0, Vec2::new(distance, 0.0), 1).next().unwrap();
        assert!(chain.rest < distance / (chain.relays + 1) as f64);
        assert!(chain.rest <= 1.4);
    }
}
