//! Where the springs of the axisymmetric engine stand.

/// Where springs begin and end, from the axis to `end_m`. Where the contacts between which a cycle swings are known, half of the
/// springs or more lie where the edge of the contact moves, so that however little it moves they resolve it, and it turns
/// where one of them ends, whatever their number: errors of different numbers of springs then differ by their order alone. Half
/// of these lie beyond the contact under the mean: above the spectrum a strongly relaxing body hardly lets the edge move there,
/// and the force falls to zero, and the pressure has its peak, within as little.
pub(super) fn places_m(end_m: f64, extremes_m: Option<[f64; 3]>, springs: usize) -> Vec<f64> {
    /// Of the springs within the largest contact, the most that lie where contact never ends.
    const FIXED: f64 = 0.5;
    /// Parts of the largest contact narrower than this have no springs of their own.
    const NARROWEST: f64 = 1e-12;
    let evenly = |from_m: f64, to_m: f64, count: usize| {
        let width_m = (to_m - from_m) / count as f64;
        (0..count).map(move |i| from_m + i as f64 * width_m)
    };
    let uniform = || evenly(0.0, end_m, springs).chain([end_m]).collect();
    let Some([always_m, mean_m, largest_m]) = extremes_m else {
        return uniform();
    };
    let is_narrow = |from_m: f64, to_m: f64| to_m - from_m <= NARROWEST * largest_m;
    if largest_m >= end_m || is_narrow(mean_m, largest_m) || is_narrow(always_m, mean_m) {
        return uniform();
    }
    let count = |part: f64| (springs as f64 * part).round() as usize;
    let fixed = count((always_m / largest_m).min(FIXED));
    let always_m = if fixed > 0 { always_m } else { 0.0 };
    let beyond = (springs - fixed) / 2;
    let mut places_m: Vec<f64> = evenly(0.0, always_m, fixed)
        .chain(evenly(always_m, mean_m, springs - fixed - beyond))
        .chain(evenly(mean_m, largest_m, beyond))
        .chain([largest_m])
        .collect();
    // Past the largest, for what discretisation adds, springs grow as fast as they may.
    let (mut place_m, mut width_m) = (largest_m, (largest_m - mean_m) / beyond as f64);
    while place_m < end_m {
        place_m = (place_m + width_m).min(end_m);
        width_m *= 2.0;
        places_m.push(place_m);
    }
    places_m
}
