//! Scenes run on many threads at once, and give what they give alone.

use std::thread;

use pliant::samples::square_jump;
use pliant::{Error, Method, Sampling, Scene, Settings, Trajectory};

#[test]
fn scenes_are_shared_and_motions_handed_over() {
    fn crosses_threads<T: Send + Sync>() {}
    crosses_threads::<Scene>();
    crosses_threads::<Trajectory>();
    crosses_threads::<Error>();
}

#[test]
fn threads_do_not_disturb_each_other() {
    let scene = square_jump(4).unwrap().ended_at(1.1);
    let end = |method| {
        let settings = Settings { method, rtol: 1e-5, ..Settings::default() };
        let trajectory = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        trajectory.last().u.clone()
    };
    for method in Method::ALL {
        let alone = end(method);
        thread::scope(|scope| {
            let others: Vec<_> = (0..4).map(|_| scope.spawn(|| end(method))).collect();
            for other in others {
                assert_eq!(other.join().unwrap(), alone, "{method}");
            }
        });
    }
}
