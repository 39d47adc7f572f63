#!/usr/bin/env bash
# Mutated inputs for as long as you like: scene files, overrides, logs, saved states, sequences of Python calls.
#
#   scripts/fuzz.sh [CASES [SEED]]     100,000 cases of each target by default, within 3 GB of address space
#
# What breaks a target is left in target/fuzz. The same targets run with few cases in `cargo test`.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
export UNIPBD_FUZZ_CASES="${1:-100000}" UNIPBD_FUZZ_SEED="${2:-0}" UNIPBD_FUZZ_KEEP="$PWD/target/fuzz"
targets=(-p unipbd-core -p unipbd-cli --test fuzz_state --test fuzz)
cargo test --release --no-run "${targets[@]}" || exit 1
failed=0
ulimit -v 3000000
cargo test --release --no-fail-fast "${targets[@]}" -- --nocapture --test-threads 1 || failed=1
if [ -x target/python-tests/bin/python ]; then
    UNIPBD_FUZZ_CASES=$((UNIPBD_FUZZ_CASES / 25)) target/python-tests/bin/python -m pytest -q -s tests/python/test_sequences.py || failed=1
else
    echo "sequences of Python calls: skipped, run tests/python/run.py once"
fi
exit "$failed"
