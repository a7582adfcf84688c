#!/usr/bin/env bash
# hardening_test.sh READELF PROGRAM...: reads from each program how it was compiled and linked.
set -euo pipefail
readelf=$1
failed=0

fail() { # fail PROGRAM EXPECTED
    echo "$1: $2 was expected" >&2
    failed=1
}

# expect WHAT PATTERN: among what readelf says
expect() {
    grep -qE -e "$2" <<<"$elf" || fail "$program" "$1"
}

# expect_code WHAT COUNT BYTES: instructions in the file; those of the C runtime alone are fewer
expect_code() {
    [[ $(LC_ALL=C grep -oaP -e "$3" "$program" | wc -l) -ge $2 ]] || fail "$program" "$1"
}

for program in "${@:2}"; do
    elf=$("$readelf" --wide --segments --dynamic --dyn-syms "$program")
    expect 'a position-independent program' 'FLAGS_1.* PIE'
    expect 'a table of addresses that is read-only after the start (RELRO)' 'GNU_RELRO'
    expect 'addresses that are all known at the start (BIND_NOW)' 'FLAGS_1.* NOW'
    expect 'a stack that is not executable' 'GNU_STACK .* RW +0x'
    ! grep -q TEXTREL <<<"$elf" || fail "$program" 'code that is not written to'
    expect 'a protected stack' '__stack_chk_fail'
    expect 'checked calls of the C library (_FORTIFY_SOURCE)' '__(memcpy|memset|snprintf|fprintf)_chk'
    expect 'checked calls of the C++ library (_GLIBCXX_ASSERTIONS)' 'glibcxx_assert_fail'
    if [[ $(uname -m) == x86_64 ]]; then
        # endbr64, and the probe of each page of a large stack frame: orq $0, (%rsp)
        expect_code 'marked targets of jumps (-fcf-protection)' 100 '\xf3\x0f\x1e\xfa'
        expect_code 'probes of large stack frames (-fstack-clash-protection)' 1 '\x48\x83\x0c\x24\x00'
    fi
done
exit "$failed"
