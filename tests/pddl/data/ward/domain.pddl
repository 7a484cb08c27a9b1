; A nurse, a cart and wards: all that is not plain STRIPS, in one domain.
(define (domain ward)
  (:requirements :adl :action-costs)
  (:types
    place carrier item patient - object
    nurse cart - carrier
    sheet pill - item)
  (:constants store - place)
  (:predicates
    (at ?who - (either carrier patient) ?where - place)
    (lies ?what - item ?where - place)
    (has ?who - carrier ?what - item)
    (link ?a ?b - place)
    (made ?who - patient)
    (calm ?who - patient)
    (closed ?where - place)
    (noisy))
  (:functions (total-cost) (far ?a ?b - place))
  (:action go
    :parameters (?who - carrier ?from ?to - place)
    :precondition (and (at ?who ?from) (or (link ?from ?to) (link ?to ?from)) (not (closed ?to)))
    :effect (and (at ?who ?to) (not (at ?who ?from)) (increase (total-cost) (far ?from ?to))))
  (:action load
    :parameters (?who - carrier ?what - (either sheet pill) ?where - place)
    :precondition (and (at ?who ?where) (lies ?what ?where) (forall (?other - sheet) (not (has ?who ?other))))
    :effect (and (has ?who ?what) (not (lies ?what ?where)) (increase (total-cost) 1)))
  (:action unload
    :parameters (?who - carrier ?where - place)
    :precondition (and (at ?who ?where) (exists (?what - item) (has ?who ?what)))
    :effect (and (forall (?what - item) (when (has ?who ?what) (and (lies ?what ?where) (not (has ?who ?what)))))
                 (increase (total-cost) 0.5)))
  (:action give
    :parameters (?giver ?taker - carrier ?what - item ?where - place)
    :precondition (and (at ?giver ?where) (at ?taker ?where) (has ?giver ?what) (not (= ?giver ?taker)))
    :effect (and (has ?taker ?what) (not (has ?giver ?what)) (increase (total-cost) 1)))
  (:action make
    :parameters (?who - nurse ?patient - patient ?what - sheet ?where - place)
    :precondition (and (at ?who ?where) (at ?patient ?where) (has ?who ?what))
    :effect (and (made ?patient) (not (has ?who ?what)) (when (not (noisy)) (calm ?patient))
                 (increase (total-cost) 2)))
  (:action calm
    :parameters (?who - nurse ?patient - patient ?where - place)
    :precondition (imply (noisy) (and (at ?who ?where) (at ?patient ?where)))
    :effect (and (calm ?patient) (increase (total-cost) 4)))
  (:action hush
    :parameters (?who - carrier)
    :precondition (noisy)
    :effect (and (not (noisy)) (increase (total-cost) (/ 3 4)))))
