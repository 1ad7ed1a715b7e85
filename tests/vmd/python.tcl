# python.tcl: espdiff.vmd in VMD's own Python: the numbers of the Tcl package, molecules, atomsels, drawings, Ctrl-C's errors.
source [file join $env(ESPDIFF_TESTS) support.tcl]

if {[info commands gopython] eq ""} {
    note "MESSAGE: SKIPPED: this VMD was built without Python; VMD=vmd-python names one that has it"
    finish
    return
}
set env(ESPDIFF_PYTHON_RESULT) [file join $scratch python.result]
gopython [file join $env(ESPDIFF_TESTS) python_module.py]
if {[catch { open $env(ESPDIFF_PYTHON_RESULT) } channel]} {
    note "FAILED python: the script wrote no result"
} else {
    note [string trim [read $channel]]
    close $channel
}
finish
