# matrix.tcl: the command matrix: many variants, each with each, by label.

namespace eval ::espdiff {
    proc matrix {options variants} {
        set temporary {}
        set handle [submit temporary {
            core::matrix [make_variants $variants temporary] [matrix_options $options]
        }]
        begin_job $handle $options [dict create temporary $temporary]
    }

    proc merge {options states} {
        set paths {}
        foreach path [list_of $states "espdiff merge"] { lappend paths [existing_file $path "espdiff merge"] }
        set core [dict create output [file normalize [dict get $options output]]]
        return [core::merge $paths [dict merge $core [study_values merge $options]]]
    }

    proc matrix_options {options} {
        set core [dict merge [core_options $options] [study_values matrix $options]]
        dict set core template [full_name [dict get $options template]]
        # The working folder may change during a background computation.
        dict set core output [file normalize [dict get $options output]]
        return $core
    }

    # The user's variants for the core: endpoints with label and group.
    proc make_variants {variants temporary_name} {
        upvar 1 $temporary_name temporary
        if {![string is list $variants]} { fail "variants: '$variants' is not a list of endpoints" }
        set made {}
        foreach text [usual_variant_maps $variants] {
            set role "variant [expr {[llength $made] + 1}]"
            set variant [split_variant $text $role]
            foreach endpoint [each_state [dict get $variant endpoint] $role] {
                lassign $endpoint state suffix
                set result [make_endpoint $state $role temporary]
                dict set result label [dict get $variant label]$suffix
                dict set result group [dict get $variant group]
                lappend made $result
            }
        }
        if {[llength $made] < 2} {
            fail "variants: there [expr {[llength $made] == 1 ? {is 1} : {are none}}]; a matrix needs two or more"
        }
        return [set_apart $made]
    }

    # Variants without maps get the potential that is usual for all of them.
    proc usual_variant_maps {variants} {
        foreach text $variants {
            if {![string is list $text] || [llength $text] % 2} { return $variants }
        }
        return [with_usual_maps $variants]
    }

    # Separates label and group from the endpoint.
    proc split_variant {text role} {
        if {![string is list $text] || [llength $text] % 2 || [llength $text] == 0} {
            fail "$role: '$text' is not {mol ID ?key value ...?} or {file PATH ?key value ...?}"
        }
        set endpoint [dict remove $text label group frames]
        parse_endpoint $endpoint $role
        if {[dict exists $text frames]} {
            if {![dict exists $text mol]} { fail "$role: `frames` are of a molecule in VMD; of a file name the model" }
            if {[dict exists $text frame]} { fail "$role: `frame` and `frames` were given; leave one out" }
            dict set endpoint frames [dict get $text frames]
        }
        return [dict create endpoint $endpoint group [value_or $text group ""] \
            label [value_or $text label [usual_label $endpoint $role]]]
    }

    proc usual_label {endpoint role} {
        if {[dict exists $endpoint file]} { return [file rootname [file tail [dict get $endpoint file]]] }
        return [molinfo [vmd_molecule_id [dict get $endpoint mol] $role] get name]
    }

    # The endpoint of each frame or model, and the suffix that distinguishes it.
    proc each_state {endpoint role} {
        set states {}
        if {[dict exists $endpoint frames]} {
            set mol [vmd_molecule_id [dict get $endpoint mol] $role]
            vmd_frame $mol last $role
            set frames [vmd_frames $mol [dict get $endpoint frames] "$role: frames"]
            foreach frame $frames {
                lappend states [list [dict merge [dict remove $endpoint frames] [list frame $frame]] :$frame]
            }
            return $states
        }
        set n 1
        if {[dict exists $endpoint file] && ![dict exists $endpoint model]} {
            set n [core::models [existing_file [dict get $endpoint file] $role]]
        }
        if {$n == 1} { return [list [list $endpoint ""]] }
        for {set model 1} {$model <= $n} {incr model} {
            lappend states [list [dict merge $endpoint [list model $model]] :$model]
        }
        return $states
    }

    # Adds numbers to labels that several variants share, such as two molecules of one name in VMD.
    proc set_apart {variants} {
        set count [dict create]
        foreach variant $variants { dict incr count [dict get $variant label] }
        set seen [dict create]
        set result {}
        foreach variant $variants {
            set label [dict get $variant label]
            if {[dict get $count $label] > 1} {
                dict incr seen $label
                dict set variant label "$label #[dict get $seen $label]"
            }
            lappend result $variant
        }
        return $result
    }
}
