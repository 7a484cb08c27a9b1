; Eve shows the projector's slides in the hall upstairs; until minute 12 a meeting keeps it.
(define (problem office)
  (:domain office)
  (:objects eve carl - person
            rolf - robot
            desk post lobby meeting-room landing hall - place
            projector - thing)
  (:init (at eve desk) (at rolf hall) (at carl post)
         (way desk lobby) (way lobby desk) (way post lobby) (way lobby post)
         (way lobby meeting-room) (way meeting-room lobby) (way landing hall) (way hall landing)
         (shaft lobby landing) (shaft landing lobby) (lift-at lobby)
         (lies projector meeting-room)
         (free desk) (free post) (free lobby) (free landing) (free hall)
         (at 12 (free meeting-room)))
  (:goal (shown projector hall)))
