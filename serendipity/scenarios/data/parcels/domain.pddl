; Drivers take parcels to where they are wanted, in vehicles to which they have the key.
(define (domain parcels)
  (:requirements :strips :typing :multi-agent)
  (:types place thing - object
          driver vehicle parcel - thing)
  (:predicates (path ?a ?b - place) (road ?a ?b - place) (open-to ?car - vehicle ?where - place)
               (at ?what - thing ?where - place) (key ?who - driver ?car - vehicle)
               (drives ?who - driver ?car - vehicle) (in ?what - parcel ?car - vehicle))
  (:action walk
    :agent ?who - driver
    :parameters (?from ?to - place)
    :precondition (and (at ?who ?from) (path ?from ?to))
    :effect (and (at ?who ?to) (not (at ?who ?from))))
  (:action enter
    :agent ?who - driver
    :parameters (?car - vehicle ?where - place)
    :precondition (and (at ?who ?where) (at ?car ?where) (key ?who ?car))
    :effect (and (drives ?who ?car) (not (at ?who ?where))))
  (:action leave
    :agent ?who - driver
    :parameters (?car - vehicle ?where - place)
    :precondition (and (drives ?who ?car) (at ?car ?where))
    :effect (and (at ?who ?where) (not (drives ?who ?car))))
  (:action drive
    :agent ?who - driver
    :parameters (?car - vehicle ?from ?to - place)
    :precondition (and (drives ?who ?car) (at ?car ?from) (road ?from ?to) (open-to ?car ?to))
    :effect (and (at ?car ?to) (not (at ?car ?from))))
  (:action load
    :agent ?who - driver
    :parameters (?what - parcel ?car - vehicle ?where - place)
    :precondition (and (drives ?who ?car) (at ?car ?where) (at ?what ?where))
    :effect (and (in ?what ?car) (not (at ?what ?where))))
  (:action deliver
    :agent ?who - driver
    :parameters (?what - parcel ?car - vehicle ?where - place)
    :precondition (and (drives ?who ?car) (at ?car ?where) (in ?what ?car))
    :effect (and (at ?what ?where) (not (in ?what ?car)))))
