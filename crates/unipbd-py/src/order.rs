//! Rows in the order of their ids: the order of every array that Python sees.

const NOBODY: u32 = u32::MAX;

/// Rows in ascending order of their ids.
pub fn by_id(ids: &[u32]) -> Vec<u32> {
    if ids.is_empty() {
        return Vec::new();
    }
    let (least, most) = ids.iter().fold((u32::MAX, 0), |(least, most), &id| (least.min(id), most.max(id)));
    let span = (most - least) as usize + 1;
    if span > 4 * ids.len() + 1024 {
        let mut rows: Vec<u32> = (0..ids.len() as u32).collect();
        rows.sort_unstable_by_key(|&row| ids[row as usize]);
        return rows;
    }
    let mut rows = vec![NOBODY; span];
    for (&id, row) in ids.iter().zip(0..) {
        rows[(id - least) as usize] = row;
    }
    if span > ids.len() {
        rows.retain(|&row| row != NOBODY);
    }
    rows
}
