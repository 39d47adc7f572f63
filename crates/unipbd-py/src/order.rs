//! Rows in the order of their ids: the order of every array that Python sees.

/// Rows in ascending order of their ids.
pub fn by_id(ids: &[u32]) -> Vec<u32> {
    let (Some(&least), Some(&most)) = (ids.iter().min(), ids.iter().max()) else { return Vec::new() };
    let span = (most - least) as usize + 1;
    if span > 4 * ids.len() + 1024 {
        let mut rows: Vec<u32> = (0..ids.len() as u32).collect();
        rows.sort_unstable_by_key(|&row| ids[row as usize]);
        return rows;
    }
    let mut places = vec![u32::MAX; span];
    for (row, &id) in ids.iter().enumerate() {
        places[(id - least) as usize] = row as u32;
    }
    places.retain(|&row| row != u32::MAX);
    places
}
