# load.tcl: the package loads into VMD, its file types are known there, and a second interpreter has its own handles.
source [file join $env(ESPDIFF_TESTS) support.tcl]

test "the package loads, and VMD took its file types" {
    package require espdiff
    set abi [::espdiff::core::abi]
    check "in VMD" {[dict get $abi in_vmd]}
    set types {}
    foreach plugin [plugin list] { lappend types [lindex $plugin 1] }
    foreach type {espdiffvolume espdiffmap vti} { check "file type $type" {$type in $types} }
}

test "doctor names VMD, the accepted interface and the back ends" {
    set text [espdiff doctor]
    foreach word [list [vmdinfo version] cpu cuda [dict get [::espdiff::core::abi] abi]] {
        check "doctor says $word" {[string first $word $text] >= 0}
    }
}

test "a second interpreter has handles of its own, and takes them with it" {
    set child [interp create]
    $child eval [list set auto_path $auto_path]
    $child eval { package require espdiff }
    set files [list [list file [input ubq/ubq.pqr]] [list file [input ubq/ubq.pqr]]]
    set mine [espdiff compare {*}$files]
    set other [$child eval [list espdiff compare {*}$files]]
    check_equal "handles here" [espdiff handles] $mine
    check_equal "handles there" [$child eval {espdiff handles}] $other
    $child eval [list espdiff compare {*}$files -command puts]
    interp delete $child
    check_equal "still there" [espdiff result $mine certificate trustworthy] 1
    espdiff delete all
}

test "the module can be unloaded from an interpreter while it computes there" {
    set child [interp create]
    load [::espdiff::module_path] Espdiff $child
    $child eval [list ::espdiff::core::compare [list file [input ref_apbs/1tca.pqr]] [list file [input ref_apbs/1tca.pqr]] {}]
    unload [::espdiff::module_path] Espdiff $child
    check_equal "commands" [$child eval {info commands ::espdiff::core::*}] {}
    interp delete $child
    set here [espdiff compare [list file [input ubq/ubq.pqr]] [list file [input ubq/ubq.pqr]]]
    espdiff delete $here
}

finish
