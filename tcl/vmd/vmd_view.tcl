# vmd_view.tcl: preserves the user's view over VMD commands that change it as a side effect.

namespace eval ::espdiff {
    variable matrices {center_matrix rotate_matrix scale_matrix global_matrix}

    # Evaluates `body` in the caller, then restores view, top molecule, and active and displayed states of all existing
    # molecules. (Loading a map or a graphics molecule resets every view and changes the top molecule.)
    proc keep_view {body} {
        set view [saved_view]
        # With updates off, VMD would postpone the reset until after we have restored the view.
        set updates [display update status]
        display update on
        finally { uplevel 1 $body } {
            display update [expr {$updates ? "on" : "off"}]
            restore_view $view
        }
    }

    proc saved_view {} {
        variable matrices
        set molecules [dict create]
        foreach mol [molinfo list] {
            dict set molecules $mol [molinfo $mol get [concat $matrices active displayed]]
        }
        return [dict create molecules $molecules top [molinfo top]]
    }

    proc restore_view {view} {
        variable matrices
        set now [molinfo list]
        dict for {mol state} [dict get $view molecules] {
            if {$mol in $now} { molinfo $mol set [concat $matrices active displayed] $state }
        }
        if {[dict get $view top] in $now} { mol top [dict get $view top] }
    }

    # Gives a new molecule the view of another one.
    proc copy_view {from to} {
        variable matrices
        molinfo $to set $matrices [molinfo $from get $matrices]
    }
}
