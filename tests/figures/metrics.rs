//! Connectivity against closed forms, against a dense eigenvalue solver, and against exhaustive search.

use std::f64::consts::PI;

use desim::engine::{ActorId, Purpose, Streams};
use desim::geometry::Vec2;
use desim::metrics::{Chains, Graph};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// The iteration stops at a residual of 1e-8 of the eigenvalue, which bounds its relative error.
const LAMBDA2_TOLERANCE: f64 = 1e-8;

fn assert_lambda2(name: &str, graph: &Graph, expected: f64) {
    let found = graph.algebraic_connectivity();
    assert!(
        (found - expected).abs() <= LAMBDA2_TOLERANCE * expected,
        "{name}: {found} instead of {expected}"
    );
}

fn path(n: u32) -> Graph {
    Graph::new(n as usize, (1..n).map(|i| [i - 1, i]))
}

fn cycle(n: u32) -> Graph {
    Graph::new(n as usize, (0..n).map(|i| [i, (i + 1) % n]))
}

fn complete(n: u32) -> Graph {
    Graph::new(n as usize, (0..n).flat_map(|i| (0..i).map(move |j| [j, i])))
}

fn petersen() -> Graph {
    let edges = (0..5).flat_map(|i| [[i, (i + 1) % 5], [i, i + 5], [i + 5, (i + 2) % 5 + 5]]);
    Graph::new(10, edges)
}

#[test]
fn lambda2_of_complete_graphs_is_their_size() {
    for n in [2, 3, 10, 80] {
        assert_lambda2("complete", &complete(n), f64::from(n));
    }
}

#[test]
fn lambda2_of_stars_is_one() {
    for n in [3, 10, 100] {
        assert_lambda2("star", &Graph::new(n as usize, (1..n).map(|i| [0, i])), 1.0);
    }
}

#[test]
fn lambda2_of_paths_and_cycles_follows_the_cosine() {
    for n in [3, 10, 20, 1000] {
        let angle = PI / f64::from(n);
        assert_lambda2("path", &path(n), 2.0 * (1.0 - angle.cos()));
        assert_lambda2("cycle", &cycle(n), 2.0 * (1.0 - (2.0 * angle).cos()));
    }
    assert!((path(10).algebraic_connectivity() - 0.097_887_0).abs() < 5e-8);
    assert!((path(20).algebraic_connectivity() - 0.024_623_3).abs() < 5e-8);
    assert!((cycle(10).algebraic_connectivity() - 0.381_966_0).abs() < 5e-8);
}

#[test]
fn lambda2_of_complete_bipartite_graphs_is_the_smaller_side() {
    for (a, b) in [(2, 3), (5, 5), (7, 30)] {
        let graph = Graph::new((a + b) as usize, (0..a).flat_map(|i| (a..a + b).map(move |j| [i, j])));
        assert_lambda2("bipartite", &graph, f64::from(a));
    }
}

#[test]
fn lambda2_of_hypercubes_and_of_the_petersen_graph_is_two() {
    for dimension in [1, 2, 3, 6, 9] {
        let corners = 0..1_u32 << dimension;
        let edges = corners
            .clone()
            .flat_map(|corner| (0..dimension).map(move |bit| [corner, corner ^ (1 << bit)]));
        assert_lambda2("hypercube", &Graph::new(corners.len(), edges), 2.0);
    }
    assert_lambda2("Petersen", &petersen(), 2.0);
}

#[test]
fn lambda2_of_graphs_in_pieces_is_exactly_zero() {
    let two_triangles = Graph::new(6, [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]);
    for (graph, components) in [
        (two_triangles, 2),
        (Graph::new(3, []), 3),
        (Graph::new(1, []), 1),
        (Graph::new(0, []), 0),
    ] {
        assert_eq!(
            (graph.algebraic_connectivity().to_bits(), graph.components()),
            (0, components)
        );
    }
}

/// `count` points, uniform in a square of which `scatter` names one of many.
fn scattered(count: u32, side: f64, scatter: u32) -> Vec<Vec2> {
    let streams = Streams::new(11, scatter).keyed(Purpose::new("test.scatter"));
    let point = |i| {
        let mut random = streams.at(i, 0, 0);
        let mut coordinate = || side * f64::from(random.next_u32()) / f64::from(u32::MAX);
        Vec2::new(coordinate(), coordinate())
    };
    (0..count).map(point).collect()
}

/// The second least eigenvalue of the Laplacian, by a dense solver.
fn dense_lambda2(graph: &Graph) -> f64 {
    let mut laplacian = DMatrix::zeros(graph.vertices(), graph.vertices());
    for [a, b] in graph.edges().iter().map(|edge| edge.map(|end| end as usize)) {
        laplacian[(a, a)] += 1.0;
        laplacian[(b, b)] += 1.0;
        laplacian[(a, b)] = -1.0;
        laplacian[(b, a)] = -1.0;
    }
    let mut eigenvalues: Vec<f64> = laplacian.symmetric_eigenvalues().iter().copied().collect();
    eigenvalues.sort_by(f64::total_cmp);
    eigenvalues[1]
}

fn assert_dense_agrees(graph: &Graph) {
    let (found, dense) = (graph.algebraic_connectivity(), dense_lambda2(graph));
    let rounding = graph.vertices() as f64 * f64::EPSILON * 100.0;
    assert!(
        (found - dense).abs() <= LAMBDA2_TOLERANCE * dense + rounding,
        "{} vertices: {found}, dense {dense}",
        graph.vertices()
    );
}

#[test]
fn lambda2_agrees_with_a_dense_solver_on_random_unit_disk_graphs() {
    // 20 neighbours on average, fewer at the border: most graphs are connected. The dense solver is right to about
    // n·ε·λmax.
    let mut connected = 0;
    for (scatter, count) in (0..).zip([5, 20, 40, 80, 80, 300, 300, 500, 1000]) {
        let side = 2.0 * (PI * f64::from(count) / 20.0).sqrt();
        let graph = Graph::within_range(&scattered(count, side, scatter), 2.0);
        connected += u32::from(graph.components() == 1);
        assert_dense_agrees(&graph);
    }
    assert!(connected >= 6, "only {connected} of 9 graphs are connected");
}

#[test]
fn lambda2_agrees_with_a_dense_solver_on_sparse_random_graphs_of_any_numbering() {
    for scatter in 0..4 {
        let count = 300 + 100 * scatter;
        let mut random = Streams::new(12, scatter).keyed(Purpose::new("test.edges")).at(0, 0, 0);
        let mut any = || random.next_u32() % count;
        let tree_and_chords: Vec<[u32; 2]> = (1..count)
            .map(|i| [i, any() % i])
            .chain((0..count).map(|i| [i, (i * i + 7) % count]))
            .collect();
        let graph = Graph::new(count as usize, tree_and_chords);
        assert_dense_agrees(&graph);
    }
}

proptest! {
    #[test]
    fn the_sweep_finds_exactly_the_pairs_within_range(count in 0..60_u32, side in 0.1..20.0_f64, scatter: u32) {
        let positions = scattered(count, side, scatter);
        let pairs = (0..positions.len()).flat_map(|i| (0..i).map(move |j| [j, i]));
        let near = pairs.filter(|&[i, j]| (positions[i] - positions[j]).norm_squared() <= 4.0);
        let expected = Graph::new(count as usize, near.map(|pair| pair.map(|i| i as u32)));
        let found = Graph::within_range(&positions, 2.0);
        prop_assert_eq!(found.edges().len(), expected.edges().len());
        prop_assert_eq!(found.components(), expected.components());
        let (a, b) = (found.algebraic_connectivity(), expected.algebraic_connectivity());
        prop_assert!((a - b).abs() <= 2.0 * LAMBDA2_TOLERANCE * a);
    }
}

fn ids(robots: &[u32]) -> Vec<ActorId> {
    robots.iter().copied().map(ActorId).collect()
}

fn chains(parents: &[&[u32]], from: u32) -> u32 {
    let parents: Vec<_> = parents.iter().map(|robots| ids(robots)).collect();
    Chains::new(&parents, ActorId(0), |_, _| true).count(ActorId(from))
}

#[test]
fn chains_of_known_parent_relations_number_what_menger_says() {
    assert_eq!(chains(&[&[], &[0]], 1), 1, "a direct link");
    assert_eq!(chains(&[&[], &[]], 1), 0, "no parents");
    assert_eq!(chains(&[&[], &[0]], 0), 0, "the root itself");
    assert_eq!(chains(&[&[], &[0, 0, 0]], 1), 1, "a parent named thrice");
    assert_eq!(chains(&[&[], &[2], &[1]], 1), 0, "a loop that never reaches the root");
    assert_eq!(
        chains(&[&[], &[0], &[0], &[0], &[1, 2, 3]], 4),
        3,
        "three chains side by side"
    );
    assert_eq!(
        chains(&[&[], &[0], &[1], &[1], &[2, 3]], 4),
        1,
        "two ways through one relay"
    );
    assert_eq!(
        chains(&[&[], &[0], &[0], &[1, 2], &[1], &[3, 4]], 5),
        2,
        "greedy through 3 and 1 must be undone"
    );
    assert_eq!(
        chains(&[&[], &[0], &[0, 1, 3], &[]], 2),
        2,
        "the root as a parent, and a dead end"
    );
}

#[test]
fn a_hop_that_is_out_of_range_carries_no_chain() {
    let parents = [&[][..], &[0], &[0], &[1, 2]].map(ids);
    let broken = |child: ActorId, parent: ActorId| (child, parent) != (ActorId(2), ActorId(0));
    assert_eq!(Chains::new(&parents, ActorId(0), broken).count(ActorId(3)), 1);
}

/// The most chains from `robot` to robot 0 that share nothing: every way of choosing them is tried.
fn exhaustive(parents: &[Vec<ActorId>], robot: ActorId) -> u32 {
    fn extend(parents: &[Vec<ActorId>], source: ActorId, at: ActorId, used: &mut Vec<ActorId>, direct: bool) -> u32 {
        let mut best = 0;
        for &parent in &parents[at.index()] {
            if parent == ActorId(0) {
                if at == source && direct {
                    continue;
                }
                best = best.max(1 + extend(parents, source, source, used, direct || at == source));
            } else if parent != source && !used.contains(&parent) {
                used.push(parent);
                best = best.max(extend(parents, source, parent, used, direct));
                used.pop();
            }
        }
        best
    }
    extend(parents, robot, robot, &mut vec![robot], false)
}

proptest! {
    #[test]
    fn chains_agree_with_exhaustive_search_on_small_relations(
        parents in prop::collection::vec(prop::collection::vec(0..7_u32, 0..4), 7),
    ) {
        let parents: Vec<_> = parents.iter().map(|robots| ids(robots)).collect();
        let chains = Chains::new(&parents, ActorId(0), |_, _| true);
        for robot in ids(&[1, 2, 3, 4, 5, 6]) {
            prop_assert_eq!(chains.count(robot), exhaustive(&parents, robot));
        }
    }
}
