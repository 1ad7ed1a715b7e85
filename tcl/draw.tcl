# draw.tcl: coloured surfaces as graphics molecules of VMD, and their removal.

namespace eval ::espdiff {
    # By handle: molecules (ids of the graphics molecules, the legend's last).
    variable drawings [dict create]

    # Steps of uncertainty, from 0 to the limit, and their opacity. VMD does not sort triangles: with GLSL it blends
    # triangles of opacity 0.5 or less in list order, without writing depths, and draws the others as if opaque. So no
    # opacity lies between 0.5 and 1. Steps of one opacity share a graphics molecule.
    variable opacities {1.0 1.0 1.0 0.5 0.35 0.2}

    # Three colours for the lower end, the middle and the upper end of VMD's colour scale.
    variable scales {
        diverging  {{0.78 0.08 0.10} {0.88 0.88 0.88} {0.10 0.22 0.78}}
        sequential {{0.88 0.88 0.88} {0.98 0.62 0.20} {0.45 0.05 0.05}}
    }
    variable lengths {slip displacement path_length}  ;# quantities that start at 0
    variable scale_method RWB  ;# VMD's colour scale whose colours are replaced temporarily

    variable plain_color 2    ;# gray: no quantity, and points outside a map
    variable marked_color 4   ;# yellow: corrupt parts with -corrupt mark

    proc draw {options handle} {
        require_vmd "espdiff draw" \
            "outside of it `espdiff export` writes the surface, and the command line's `espdiff render` draws it"
        require_core_handle $handle
        core::check $handle
        if {[dict get $options view] eq "linked"} { return [draw_linked $options $handle] }
        end_linked_view
        set plan [drawing_plan $options $handle]
        set older [drawing_of $handle]
        set molecules {}
        keep_view {
            set code [catch {
                with_color_scale [dict get $plan colors] {
                    draw_levels $handle $plan molecules
                    if {[dict get $plan legend]} { lappend molecules [draw_legend $plan] }
                    foreach mol $molecules { build_list $mol }
                }
            } message error]
            delete_molecules [expr {$code ? $molecules : $older}]
        }
        place_legends  ;# after keep_view, which has VMD reset the views
        if {$code} { return -options $error $message }
        remember_drawing $handle $molecules
        return $molecules
    }

    # The drawing's parameters, from options and handle: color, low, high, unit, colors, legend, and the core's options.
    proc drawing_plan {options handle} {
        variable scales
        variable lengths
        variable plain_color
        variable marked_color
        set is_surface [expr {[dict get [core::status $handle] kind] eq "surface"}]
        set color [drawn_quantity $handle [dict get $options color] $is_surface]
        set range [dict create low -1 high 1 unit ""]
        if {$color ne "none"} { set range [drawn_range $handle $color [dict get $options range]] }
        set corrupt [dict get {transparent bin mark plain hide skip} [dict get $options corrupt]]
        set plain [expr {$corrupt eq "plain" ? $marked_color : $plain_color}]
        set side [expr {[dict get $options surface] eq "mapped" ? "target" : "source"}]
        set core [dict create color $color low [dict get $range low] high [dict get $range high] corrupt $corrupt \
            plain $plain surface [dict get $options surface] uncertainty [expr {
                [dict get $options transparency] eq "displacement" ? "displacement" : "slip"}]]
        return [dict merge $range [dict create handle $handle color $color core $core \
            colors [dict get $scales [expr {$color in $lengths ? "sequential" : "diverging"}]] \
            legend [expr {[dict get $options legend] && $color ne "none"}] beside [molecule_of $handle $side] \
            levels [opacity_levels $options $is_surface] limit [dict get $options uncertainty-limit] \
            n_bins [number_of_bins $options $is_surface]]]
    }

    proc drawn_quantity {handle color is_surface} {
        if {$color eq "auto"} {
            set color [expr {$is_surface ? "potential" : "difference"}]
            if {![catch { core::range $handle $color }]} { return $color }
            return [expr {$is_surface ? "none" : [catch { core::range $handle slip }] ? "displacement" : "slip"}]
        }
        if {$color ne "none"} { core::range $handle $color }  ;# the core reports quantities that the handle lacks
        return $color
    }

    # The ends of the colour scale: symmetric about 0, so that white is 0; a length starts at 0.
    proc drawn_range {handle color range} {
        variable lengths
        set found [core::range $handle $color]
        set unit [dict get $found unit]
        if {$range ne "auto"} { return [dict create low [lindex $range 0] high [lindex $range 1] unit $unit] }
        if {$color eq "sign"} { return [dict create low -1 high 1 unit $unit] }
        if {[dict get $found p98] eq ""} { return [dict create low -1 high 1 unit $unit] }
        set high [expr {max(abs([dict get $found p02]), abs([dict get $found p98]))}]
        if {$high == 0} { set high 1.0 }
        set high [format %.2g $high]
        return [dict create low [expr {$color in $lengths ? 0 : -$high}] high $high unit $unit]
    }

    # For each graphics molecule, its opacity and steps of uncertainty.
    proc opacity_levels {options is_surface} {
        variable opacities
        if {$is_surface} { return {1.0 0} }
        if {[dict get $options transparency] eq "none"} {
            if {[dict get $options corrupt] eq "transparent"} { return [list 1.0 0 [lindex $opacities end] 1] }
            return {1.0 0}
        }
        set levels [dict create]
        set bin -1
        foreach opacity $opacities { dict lappend levels $opacity [incr bin] }
        return $levels
    }

    proc number_of_bins {options is_surface} {
        variable opacities
        if {$is_surface} { return 1 }
        if {[dict get $options transparency] ne "none"} { return [llength $opacities] }
        expr {[dict get $options corrupt] eq "transparent" ? 2 : 1}
    }

    # One graphics molecule per opacity; their ids are appended to the caller's list as they are made. Opaque ones come
    # first, because VMD draws in this order.
    proc draw_levels {handle plan molecules_name} {
        upvar 1 $molecules_name molecules
        set levels [dict get $plan levels]
        # Without transparency the limit exceeds any slip, and the second step holds the corrupt parts.
        set limit [expr {[dict get $plan n_bins] > 2 ? [dict get $plan limit] : 1e9}]
        dict for {opacity bins} $levels {
            set name "espdiff $handle [dict get $plan color]"
            if {$opacity < 1} { append name " (opacity $opacity)" }
            lappend molecules [set mol [new_graphics $name [dict get $plan beside]]]
            graphics $mol material [material_of $opacity]
            foreach bin $bins {
                core::triangles $handle $mol [dict merge [dict get $plan core] [dict create opacity_bin $bin \
                    n_bins [dict get $plan n_bins] uncertainty_limit $limit]]
            }
        }
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

    proc remember_drawing {handle molecules} {
        variable drawings
        dict set drawings $handle $molecules
    }

    # The user may have deleted some of them; VMD does not reuse ids.
    proc delete_molecules {molecules} {
        foreach mol $molecules { if {$mol in [molinfo list]} { mol delete $mol } }
    }

    proc forget_drawing {handle} {
        variable drawings
        if {![dict exists $drawings $handle]} return
        set scene [leave_linked_view $handle]
        if {[in_vmd]} { keep_view { delete_molecules [drawing_of $handle] }; restore_scene $scene; place_legends }
        dict unset drawings $handle
    }

    proc undraw {options args} {
        variable drawings
        require_vmd "espdiff undraw" "outside of it nothing is drawn"
        foreach handle $args { require_core_handle $handle }
        if {[llength $args] == 0} { set args [dict keys $drawings] }
        foreach handle $args { forget_drawing $handle }
    }
}
