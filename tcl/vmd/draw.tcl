# draw.tcl: coloured surfaces as graphics molecules of VMD, and their removal.

namespace eval ::espdiff {
    # By handle: molecules (ids of the graphics molecules, the legend last), and the options that it was drawn with.
    variable drawings [dict create]
    variable drawn_options [dict create]
    variable drawn_plans [dict create]  ;# by handle: the plan of a drawing that has a legend

    # How far the colours have faded in bands of uncertainty, from half the limit to the limit. VMD has one colour scale
    # at a time, so that each band is a graphics molecule: as few as still look like fading.
    variable fadings {0.33 0.67}
    # Opacity of these bands and of what is beyond the limit, with -uncertain transparent. With GLSL VMD blends triangles
    # of opacity 0.5 or less in list order, without writing depths, and draws the others as if opaque.
    variable opacities {0.5 0.35 0.2}
    variable neutral_grey {0.35 0.35 0.35}  ;# darker than the middle of any scale, which means 0

    # Three colours for the lower end, the middle and the upper end of VMD's colour scale. VMD's lights darken surfaces:
    # these are stronger than the same names in pictures of the command line; the other names are as there.
    variable scales {
        red-blue   {{0.78 0.08 0.10} {0.96 0.96 0.96} {0.10 0.22 0.78}}
        sequential {{0.96 0.96 0.96} {0.98 0.62 0.20} {0.45 0.05 0.05}}
    }
    # Colours by number of what is drawn by reason (`core::reasons`): trusted, slipped, on another residue, turned,
    # disagrees, off the target, without a partner, no potential, trusted with a turned side chain. Red, yellow and blue as
    # in the command line's pictures.
    variable reason_colors {8 1 4 0 11 16 7 2 15}
    variable lengths {slip displacement path_length}  ;# quantities that start at 0
    variable scale_method RWB  ;# VMD's colour scale whose colours are replaced temporarily

    variable plain_color 2    ;# gray, neutral_grey as a number: no quantity, points outside a map, what is uncertain
    variable stripe_color 8   ;# white: light stripes of unmatched surface
    variable marked_color 4   ;# yellow: parts that are not trusted, with -corrupt mark
    variable said_rendermode 0  ;# whether the user was told that transparency needs GLSL

    proc draw {options handle} {
        variable drawn_plans
        require_vmd "espdiff draw" \
            "outside of it `espdiff export` writes the surface, and the command line's `espdiff render` draws it"
        require_core_handle $handle
        core::check $handle
        advise_rendermode $options
        if {[dict get [core::status $handle] kind] eq "ensemble"} { set options [ensemble_drawing $options $handle] }
        if {[dict get $options view] eq "linked"} { return [draw_linked $options $handle] }
        end_linked_view
        set plan [drawing_plan $options $handle]
        set older [drawing_of $handle]
        forget_picked
        set molecules {}
        keep_view {
            set code [catch {
                draw_parts $handle $plan molecules
                if {[dict get $plan legend]} {
                    with_color_scale [dict get $plan colors] {
                        lappend molecules [set mol [draw_legend $plan]]
                        build_list $mol
                    }
                }
            } message error]
            delete_molecules [expr {$code ? $molecules : $older}]
        }
        if {!$code} {
            if {![dict get $options keep]} { forget_other_drawings $handle }
            show_alone $molecules
        }
        place_legends  ;# after keep_view, which has VMD reset the views
        if {$code} { return -options $error $message }
        remember_drawing $handle $molecules $options
        if {[dict get $plan legend]} { dict set drawn_plans $handle $plan }
        name_legends
        add_frame_note $handle [expr {[dict get $options surface] eq "mapped" ? "target" : "source"}]
        return $molecules
    }

    proc forget_other_drawings {handle} {
        variable drawings
        foreach other [dict keys $drawings] { if {$other ne $handle} { forget_drawing $other } }
    }

    # Without another molecule, VMD has made the legend the top molecule, and the view is of nothing.
    proc show_alone {molecules} {
        variable legends
        if {![dict exists $legends [molinfo top]]} return
        mol top [lindex $molecules 0]
        display resetview
        foreach mol [lrange $molecules 1 end] {
            if {![dict exists $legends $mol]} { copy_view [lindex $molecules 0] $mol }
        }
    }

    # VMD's rendermode Normal draws transparent surfaces as a pattern of points.
    proc advise_rendermode {options} {
        variable said_rendermode
        if {$said_rendermode || [dict get $options uncertain] ne "transparent"} return
        if {[catch { display get rendermode } mode] || $mode eq "GLSL" || "GLSL" ni [display get rendermodes]} return
        say "transparent parts look stippled in VMD's rendermode $mode; `display rendermode GLSL` draws them smoothly"
        set said_rendermode 1
    }

    # The drawing's parameters, from options and handle: color, low, high, unit, colors, legend, and the core's options.
    proc drawing_plan {options handle} {
        variable plain_color
        variable marked_color
        set is_surface [expr {[dict get [core::status $handle] kind] eq "surface"}]
        set color [drawn_quantity $handle [dict get $options color] $is_surface [dict get $options field]]
        set range [dict create low -1 high 1 unit ""]
        if {$color eq "why"} {
            dict set range reasons [core::reasons $handle]
        } elseif {$color ne "none"} {
            set range [drawn_range $handle $color [shared_range $options $handle $color]]
        }
        set side [expr {[dict get $options surface] eq "mapped" ? "target" : "source"}]
        set core [dict create color [expr {$color eq "why" ? "none" : $color}] low [dict get $range low] high [dict get $range high] \
            corrupt [dict get $options corrupt] plain $plain_color marked $marked_color \
            surface [dict get $options surface] patch [dict get $options patch]]
        set is_plain [expr {$is_surface || $color eq "why" || [dict get $options uncertain] eq "plain"}]
        if {!$is_plain} { dict set core limit [dict get $options uncertainty-limit] }
        if {$color eq "why"} { dict set core corrupt normal }
        if {[dict get [core::status $handle] kind] eq "ensemble"} {
            dict set range title [ensemble_title $handle $color]
        } elseif {[string match *:* $color]} {
            dict set range title [field_title $handle $color]
        }
        return [dict merge $range [dict create handle $handle color $color core $core \
            colors [scale_colors [expr {[starts_at_low_end $handle $color] ? "sequential" : [dict get $options colors]}]] \
            legend [expr {[dict get $options legend] && $color ne "none"}] beside [molecule_of $handle $side] \
            parts [expr {$color eq "why" ? [list [list "" 0 1.0 [reason_bands [dict get $range reasons]]]]
                : [drawn_parts $options $is_surface]}] key [legend_key $handle $options $is_surface]]]
    }

    # Red, green and blue from 0 to 1 of the lower end, the middle and the upper end.
    proc scale_colors {name} {
        variable scales
        if {[dict exists $scales $name]} { return [dict get $scales $name] }
        set colors {}
        foreach color [core::colours $name 3] {
            scan $color #%2x%2x%2x red green blue
            lappend colors [list [expr {$red / 255.0}] [expr {$green / 255.0}] [expr {$blue / 255.0}]]
        }
        return $colors
    }

    # What grey and stripes mean, for the legend.
    proc legend_key {handle options is_surface} {
        if {$is_surface} { return "" }
        set words {}
        if {[dict get [core::status $handle] kind] eq "ensemble"} { return [ensemble_key $handle $options] }
        if {[dict get $options uncertain] ne "plain" && [dict get $options color] ne "why"} {
            set how [dict get {fade grey transparent transparent} [dict get $options uncertain]]
            lappend words "$how: uncertain, slipped by [format %.3g [dict get $options uncertainty-limit]] A or more"
        }
        set side [expr {[dict get $options surface] eq "mapped" ? "target" : "source"}]
        if {[dict get [core::result $handle] certificate no_counterpart_area_fraction $side] > 0} {
            lappend words "hatched: unmatched"
        }
        return [join $words "; "]
    }

    # A quantity of a field is FIELD:QUANTITY.
    proc drawn_quantity {handle color is_surface {field ""}} {
        if {$field ne ""} {
            if {$color eq "auto"} { set color difference }
            if {$color in {none why}} { return $color }
            set color $field:$color
        }
        if {$color eq "auto"} {
            set color [expr {$is_surface ? "potential" : "difference"}]
            if {![catch { core::range $handle $color }]} { return $color }
            return [expr {$is_surface ? "none" : [catch { core::range $handle slip }] ? "displacement" : "slip"}]
        }
        if {$color ni {none why}} { core::range $handle $color }  ;# the core reports quantities that the handle lacks
        return $color
    }

    # The ends of the colour scale: symmetric about 0, so that white is 0; a length starts at 0.
    proc drawn_range {handle color range} {
        variable lengths
        set found [core::range $handle $color]
        set unit [dict get $found unit]
        if {$range ne "auto"} { return [dict create low [lindex $range 0] high [lindex $range 1] unit $unit] }
        if {$color eq "sign" || [string match *:sign $color]} { return [dict create low -1 high 1 unit $unit] }
        if {![dict get $found signed]} {
            foreach {end key} {low p02 high p98} { set $end [dict get $found $key] }
            if {!($high > $low)} { set high [expr {$low + 1}] }
            return [dict create low $low high $high unit $unit]
        }
        set high [dict get $found limit]
        return [dict create low [expr {$color in $lengths ? 0 : -$high}] high $high unit $unit]
    }

    # Whether a scale has no middle: lengths, and fields whose sign means nothing.
    proc starts_at_low_end {handle color} {
        variable lengths
        expr {$color in $lengths || ($color ni {none why} && ![dict get [core::range $handle $color] signed])}
    }

    # "Hydrophobicity (Kyte and Doolittle): difference, target - source", for the legend.
    proc field_title {handle color} {
        set words [dict create source "of the source" target "of the target" difference "difference, target - source" \
            sign "sign, target against source"]
        set quantity [lindex [split $color :] end]
        return "[dict get [core::range $handle $color] label]: [dict get $words $quantity]"
    }

    # The parts of a drawing, a graphics molecule each, opaque ones first, because VMD draws in this order: name, how far its
    # colours have faded, opacity, and what it draws: options of the core, several times. Grey and stripes have
    # colours by number, which no scale changes, and so need no part of their own.
    proc drawn_parts {options is_surface} {
        variable fadings
        variable opacities
        variable plain_color
        variable stripe_color
        set style [dict get $options uncertain]
        if {$is_surface} { return {{"" 0 1.0 {{}}}} }
        set grey [dict create color none plain $plain_color light $stripe_color hatches 1]
        set uncertain [dict merge $grey {from 1}]
        if {$style eq "plain"} { return [list [list "" 0 1.0 [list {to 1} $uncertain]]] }
        set n [llength $fadings]
        set between {}
        for {set i 0} {$i < $n} {incr i} {
            set band [list from [expr {0.5 + 0.5 * $i / $n}] to [expr {0.5 + 0.5 * ($i + 1) / $n}]]
            set share [lindex $fadings $i]
            if {$style eq "fade"} {
                lappend between [list "faded [expr {round(100 * $share)}] %" $share 1.0 [list $band]]
            } else {
                set opacity [lindex $opacities $i]
                lappend between [list "opacity $opacity" 0 $opacity [list $band]]
            }
        }
        if {$style eq "fade"} { return [linsert $between 0 [list "" 0 1.0 [list {to 0.5} $uncertain]]] }
        set least [lindex $opacities end]
        return [concat [list [list "" 0 1.0 [list {to 0.5} [dict merge $grey {from 1e8}]]]] $between \
            [list [list "opacity $least" 0 $least [list {from 1}]]]]
    }

    # What `core::triangles` draws for each reason, and the stripes of unmatched surface.
    proc reason_bands {reasons} {
        variable reason_colors
        variable plain_color
        variable stripe_color
        set bands {}
        foreach {reason words area} $reasons {
            lappend bands [list reason $reason plain [lindex $reason_colors $reason]]
        }
        return [lappend bands [list plain $plain_color light $stripe_color hatches 1 from 1e8]]
    }

    # One graphics molecule for each part that has triangles; their ids are appended to the caller's list as they are
    # made.
    proc draw_parts {handle plan molecules_name} {
        upvar 1 $molecules_name molecules
        foreach part [dict get $plan parts] {
            lassign $part what faded opacity bands
            set name [graphics_name $handle [expr {$what eq "" ? [dict get $plan color] : $what}]]
            lappend molecules [set mol [new_graphics $name [dict get $plan beside]]]
            graphics $mol material [material_of $opacity]
            set n 0
            with_color_scale [faded_colors [dict get $plan colors] $faded] {
                foreach band $bands { incr n [draw_band $handle $mol [dict merge [dict get $plan core] $band]] }
                if {$what eq ""} { add_pick_points $handle $mol [dict get $plan core surface] }
                build_list $mol
            }
            if {$n == 0 && $what ne ""} {
                mol delete $mol
                set molecules [lrange $molecules 0 end-1]
            }
        }
    }

    # Of the target's surface that nothing was mapped to only the stripes: the rest is covered by the mapped surface.
    proc draw_band {handle mol core} {
        set n [core::triangles $handle $mol $core]
        if {![dict exists $core hatches] || [dict get $core surface] ne "mapped"} { return $n }
        expr {$n + [core::triangles $handle $mol [dict merge $core {surface uncovered limit 0 from 1e8}]]}
    }

    # A scale's colours mixed with grey.
    proc faded_colors {colors faded} {
        variable neutral_grey
        set mixed {}
        foreach color $colors {
            set entries {}
            foreach a $color b $neutral_grey { lappend entries [expr {(1 - $faded) * $a + $faded * $b}] }
            lappend mixed $entries
        }
        return $mixed
    }

    # "espdiff 1: difference", short for VMD's list of molecules.
    proc graphics_name {handle what} {
        regsub {^comparison(\d+)$} $handle {\1} number
        return "espdiff $number: $what"
    }

    # A graphics molecule with the view of `beside`, otherwise of the top molecule.
    proc new_graphics {name beside} {
        set top [molinfo top]
        set mol [mol load graphics $name]
        if {$beside eq "" && $top >= 0} { set beside $top }
        if {$beside ne ""} { copy_view $beside $mol }
        return $mol
    }

    # A material for each opacity, made once; the user's changes to it are kept. Where both of VMD's lights fall,
    # ambient and diffuse light add up to 1; more would wash out the colours.
    proc material_of {opacity} {
        set name Espdiff[format %.0f [expr {100 * $opacity}]]
        if {$name ni [material list]} {
            material add $name copy Opaque
            foreach {property value} {ambient 0.15 diffuse 0.55 specular 0.1 shininess 0.45} {
                material change $property $name $value
            }
            material change opacity $name $opacity
        }
        return $name
    }

    # Evaluates `body` in the caller with our colours. VMD has one colour scale of 1,024 steps for everything, made from
    # the three colours of a method, the midpoint, and "min", which is added to red, green and blue. Graphics store the
    # number of a step until their display list is built, and then red, green and blue. So we set our colours, draw,
    # have the lists built (build_list), and restore the user's colours. Lists are rebuilt when something is added to
    # their molecule, never for a change of the scale. Colours by number (0 to 32) are not affected. Representations
    # coloured by the scale notice the change and use the restored colours at the next redraw.
    proc with_color_scale {colors body} {
        variable scale_method
        set method [colorinfo scale method]
        set midpoint [colorinfo scale midpoint]
        set min [colorinfo scale min]
        set user [color scale colors $scale_method]
        finally {
            color scale method $scale_method
            color scale midpoint 0.5
            color scale min 0.0
            color scale colors $scale_method {*}$colors
            uplevel 1 $body
        } {
            color scale colors $scale_method {*}$user
            color scale method $method
            color scale midpoint $midpoint
            color scale min $min
        }
    }

    # Makes VMD build the molecule's display list, which it does when a frame is chosen, even if there is none.
    proc build_list {mol} { molinfo $mol set frame [molinfo $mol get frame] }

    proc drawing_of {handle} {
        variable drawings
        return [value_or $drawings $handle {}]
    }

    proc remember_drawing {handle molecules options} {
        variable drawings
        variable drawn_plans
        variable drawn_options
        dict set drawings $handle $molecules
        dict unset drawn_plans $handle
        dict set drawn_options $handle $options
        watch_drawings
    }

    # The user may have deleted some of them; VMD does not reuse ids.
    proc delete_molecules {molecules} {
        foreach mol $molecules { if {$mol in [molinfo list]} { mol delete $mol } }
    }

    proc forget_drawing {handle} {
        variable drawings
        variable drawn_plans
        if {![dict exists $drawings $handle]} return
        set scene [leave_linked_view $handle]
        if {[in_vmd]} { forget_pick_points $handle }
        if {[in_vmd]} { keep_view { delete_molecules [drawing_of $handle] }; restore_scene $scene; place_legends }
        dict unset drawings $handle
        dict unset drawn_plans $handle
        forget_frame_note $handle
        watch_drawings
        if {[in_vmd]} { name_legends }
    }

    proc undraw {options args} {
        variable drawings
        require_vmd "espdiff undraw" "outside of it nothing is drawn"
        foreach handle $args { require_core_handle $handle }
        if {[llength $args] == 0} { set args [dict keys $drawings] }
        foreach handle $args { forget_drawing $handle }
    }
}
